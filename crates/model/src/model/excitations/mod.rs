//! `excitations:`.

mod checks;
mod classes;
mod limits;

use symdiff::Formula;

pub use self::checks::check_limits;
use self::limits::Limits;
use super::names::Reader;
use super::random;
use crate::elements::{Excitation, Timing, Trajectory};
use crate::grammar::Symbol;
use crate::grammar::dimension::KnownDimension;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::description::{Parameter, ParameterValue};
use crate::model::parameters::{deviation_of, seed_of};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Entry;

/// Sections whose names formulas may use too.
const OTHERS: [&str; 6] = ["parameters", "bodies", "joints", "effects", "states", "trajectories"];

/// Reads the excitations of a model, after its trajectories.
pub fn read(reader: &mut Reader, fields: &Fields) {
    let Some(node) = fields.get("excitations") else { return };
    for entry in reader.entries(node, "excitations") {
        let named = reader.name(entry, "an excitation");
        let is_taken = |section: &&str| fields.get(section).is_some_and(|section| section.get(&entry.key).is_some());
        if OTHERS.iter().any(is_taken) {
            let message = format!("something else is called `{}` too", clip(&entry.key));
            reader.error(
                Code::NameTaken,
                entry.key_span.clone(),
                message,
                "give the excitation another name".to_owned(),
            );
            continue;
        }
        let Some(found) = excitation(reader, entry).filter(|_| named) else { continue };
        if found.excitation().is_some() {
            add_deviation(reader, &entry.key);
        }
        reader.model.mechanism_mut().trajectories.push(found);
    }
}

/// Adds the parameter that an excitation is as a constant, which no formula of the file evaluates.
fn add_deviation(reader: &mut Reader, name: &str) {
    let value = ParameterValue::Interval { nominal: 0.0, lower: -1.0, upper: 1.0 };
    let parameter = Parameter { name: deviation_of(name), unit: String::new(), value };
    reader.model.parameters.push(parameter);
    reader.kinds.push(KnownDimension::parameter(Dimension::NUMBER));
    reader.varies.push(true);
    reader.used.push(true);
    reader.used_by_parameters.push(false);
    reader.corners.iter_mut().for_each(|corner| corner.values.push(0.0));
}

fn excitation(reader: &mut Reader, entry: &Entry) -> Option<Trajectory> {
    let fields = reader.fields::<keys::Excitation>(&entry.value, entry.key_span.clone())?;
    if random::is_random(&fields) {
        return random::read(reader, entry, &fields);
    }
    let mut dimension = None;
    let (limits, class) = classes::read(reader, entry, &fields, &mut dimension)?;
    let Limits { middle, reach } = limits;
    let deviation = Formula::name(&deviation_of(&entry.key));
    let timing = Timing::Within(Box::new(Excitation { deviation, middle, reach, class }));
    Some(Trajectory { name: entry.key.clone(), points: Vec::new(), timing, dimension })
}

/// Reports joints that an excitation would drive: they need its acceleration, which is not known.
pub fn check_joints(reader: &mut Reader, entries: &[Entry]) {
    let names_one = |formula: &Formula| {
        formula.names().find_map(|(name, _)| match reader.symbol(name) {
            Some(Symbol::Trajectory { trajectory, .. }) => {
                let trajectory = &reader.model.trajectories[trajectory];
                trajectory.excitation().map(|_| trajectory.name.clone())
            }
            _ => None,
        })
    };
    let mut found = Vec::new();
    for joint in &reader.model.joints {
        let Some(excitation) = joint.kind.formulas().into_iter().find_map(names_one) else { continue };
        let entry = entries.iter().find(|entry| entry.key == joint.name);
        found.extend(entry.map(|entry| (entry.key_span.clone(), excitation)));
    }
    for (index, excitation) in found {
        let message =
            format!("a joint cannot follow the excitation `{}`: its acceleration is not known", clip(&excitation));
        reader.error(Code::BadExcitation, index, message, "let a force follow it, or a `servo`".to_owned());
    }
}

/// Leaves out the parameters of excitations that nothing uses, and warns of these.
pub fn unused(reader: &mut Reader, fields: &Fields) -> Vec<Diagnostic> {
    let Some(node) = fields.get("excitations") else { return Vec::new() };
    let mut warnings = Vec::new();
    for entry in reader.entries(node, "excitations") {
        let index = reader.model.trajectories.iter().position(|own| own.name == entry.key);
        let Some(index) = index.filter(|index| !reader.used_trajectories.contains(index)) else { continue };
        match &reader.model.trajectories[index].timing {
            Timing::Within(_) => reader.idle.insert(deviation_of(&entry.key)),
            Timing::Random(_) => reader.idle.insert(seed_of(&entry.key)),
            _ => continue,
        };
        let message = format!("excitation `{}` is used nowhere", clip(&entry.key));
        warnings.push(Diagnostic::warning(Code::UnusedExcitation, entry.key_span.clone(), message));
    }
    warnings
}
