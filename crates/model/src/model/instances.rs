//! Instances in the model: their ports, and how they stand.

use std::collections::HashMap;

use super::description::Standing;
use super::names::Reader;
use crate::expand::parts::{GROUND, Inclined, Parts};
use crate::grammar::SymbolTable;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;

/// Gives the model its ports, and reports those that are nothing; the bodies are declared.
pub fn declare_ports(reader: &mut Reader, parts: &Parts) {
    for port in &parts.ports {
        // A port may be one of an instance within.
        let target = reader.model.ports.get(&port.target).unwrap_or(&port.target).clone();
        reader.model.mechanism_mut().ports.insert(port.name.clone(), target);
    }
    for port in &parts.ports {
        let target = reader.model.ports.get(&port.name).cloned().unwrap_or_default();
        let point = target.rsplit_once('.').and_then(|(body, point)| Some((reader.model.body(body)?, point)));
        let is_point = point.is_some_and(|(body, point)| reader.model.points(body).any(|known| known == point));
        if !is_point && reader.model.body(&target).is_none() {
            let message =
                format!("port `{}` is no body and no point: there is no `{}`", clip(&port.name), clip(&target));
            let help = "write `body` or `body.point`, or `{ on: body, position: … }`".to_owned();
            reader.error(Code::UnknownName, port.span.clone(), message, help);
            reader.model.mechanism_mut().ports.remove(&port.name);
        }
    }
}

/// Gives the bodies, which are declared, the ground and the mirrors of their instances; notes effects on joints that
/// turn.
pub fn stand(reader: &mut Reader, parts: &Parts) {
    reader.model.mechanism_mut().turning_effects.clone_from(&parts.turning_effects);
    parts.inclined.iter().for_each(|inclined| check_level(reader, inclined));
    if parts.grounds.is_empty() {
        return;
    }
    let numbers: HashMap<String, usize> =
        reader.model.bodies.iter().enumerate().map(|(index, body)| (body.name.clone(), index)).collect();
    for body in &mut reader.model.mechanism_mut().bodies {
        // The innermost instance around it.
        let mut ends = body.name.rmatch_indices('.').map(|(end, _)| &body.name[..=end]);
        let found = ends.find_map(|prefix| {
            let mirrors = *parts.grounds.get(prefix)?;
            let ground = *numbers.get(&format!("{prefix}{GROUND}"))?;
            Some(Standing { ground, mirrors })
        });
        body.standing = found;
    }
}

/// Reports an effect on level ground in an instance of which the ground is not level.
fn check_level(reader: &mut Reader, inclined: &Inclined) {
    if inclined.is_level[usize::from(reader.model.space.spatial)] {
        return;
    }
    let message = format!("{} is on level ground, but in this instance the ground is not level", inclined.name);
    let help = "turn the instance about the ground's normal alone, or write the effect in the model".to_owned();
    reader.error(Code::BadPlacement, inclined.at.clone(), message, help);
}
