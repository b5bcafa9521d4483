//! Forces on sums of joints' positions: of tendons, and of actuators with their commands, memories and limits.

use super::build::PlacedRobot;
use super::tree::{Sections, keys, text};
use crate::robots::algebra::Value;
use crate::robots::mjcf::robot::{Actuator, ActuatorLaw, Length, Memory};
use crate::syntax::source::Span;
use crate::syntax::yaml::Entry;

/// The part of a force that acts on one joint.
pub struct Share {
    /// Name of its effect.
    name: String,
    joint: usize,
    force: String,
    span: Span,
}

/// The sum of positions, or rates, in a formula.
pub fn sum(source: &PlacedRobot, length: &Length, rate: bool) -> String {
    let term = |&(joint, by): &(usize, f64)| {
        let coordinate = source.robot.joints[joint].coordinate(rate);
        if by == 1.0 { coordinate } else { format!("({by:?})*{coordinate}") }
    };
    let terms: Vec<String> = length.terms.iter().map(term).collect();
    format!("({})", if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") })
}

/// A force on a sum of coordinates acts on each of them.
pub fn shares(source: &PlacedRobot, name: &str, length: &Length, force: &str, span: &Span) -> Vec<Share> {
    let share = |&(joint, by): &(usize, f64)| Share {
        name: match length.terms.len() {
            1 => name.to_owned(),
            _ => format!("{name}_{}", source.robot.joints[joint].name),
        },
        joint,
        force: if by == 1.0 { force.to_owned() } else { format!("({by:?})*({force})") },
        span: span.clone(),
    };
    length.terms.iter().map(share).collect()
}

/// Adds the effect of a force on a joint.
pub fn push(sections: &mut Sections, source: &PlacedRobot, share: &Share) {
    let (joint, span) = (&source.robot.joints[share.joint], &share.span);
    let node = keys(span, [("on", text(&joint.span, &joint.name)), ("value", text(span, &share.force))]);
    sections.add("effects", &share.name, keys(span, [("preload", node)]));
}

/// Adds the forces of all actuators; on a joint with `actuatorfrcrange` as one, within it.
pub fn add(sections: &mut Sections, source: &PlacedRobot, controls: &[Entry]) {
    let actuators = &source.robot.actuators;
    let mut all: Vec<Share> =
        actuators.iter().flat_map(|actuator| drive(sections, source, actuator, controls)).collect();
    for (index, joint) in source.robot.joints.iter().enumerate() {
        let Some([lower, upper]) = joint.force_range else { continue };
        let (own, others): (Vec<Share>, Vec<Share>) = all.into_iter().partition(|share| share.joint == index);
        all = others;
        let Some(first) = own.first() else { continue };
        let sum = own.iter().map(|share| format!("({})", share.force)).collect::<Vec<_>>().join(" + ");
        all.push(Share {
            name: if own.len() == 1 { first.name.clone() } else { format!("{}_actuators", joint.name) },
            joint: index,
            force: format!("clamp({sum}, {lower:?}, {upper:?})"),
            span: first.span.clone(),
        });
    }
    all.iter().for_each(|share| push(sections, source, share));
}

/// The force of an actuator on each of its joints.
fn drive(sections: &mut Sections, source: &PlacedRobot, actuator: &Actuator, controls: &[Entry]) -> Vec<Share> {
    let told = controls.iter().find(|entry| entry.key == actuator.name);
    let control = told.and_then(|entry| entry.value.scalar());
    let span = told.map_or(&actuator.span, |entry| &entry.value.span);
    let mut u = control.map_or_else(|| "0".to_owned(), |control| format!("({})", control.text));
    if let Some([lower, upper]) = actuator.control {
        u = match control.map_or(Ok(0.0), |control| control.text.trim().parse::<f64>()) {
            Ok(number) => format!("({:?})", number.clamp(lower.min(upper), upper)),
            Err(_) => format!("clamp({u}, {lower:?}, {upper:?})"),
        };
    }
    if let Some(memory) = actuator.memory {
        let state = format!("{}_activation", actuator.name);
        let rate = match memory {
            Memory::Integrator => u,
            Memory::Lag(time) => format!("({u} - {state})/{time:?}"),
        };
        sections.add("states", &state, keys(span, [("rate", text(span, rate)), ("initial", text(span, "0"))]));
        u = state;
    }
    let gear = source.value(&actuator.gear).text();
    let length = || format!("{gear}*({} + ({:?}))", sum(source, &actuator.on, false), actuator.offset);
    let rate = || format!("{gear}*{}", sum(source, &actuator.on, true));
    let number = |number| source.value(number).text();
    let mut force = match &actuator.law {
        ActuatorLaw::Affine { gain, bias: [constant, by_length, by_rate] } => {
            let mut terms = vec![if *gain == 1.0 { u } else { format!("({gain:?})*{u}") }];
            if *constant != 0.0 {
                terms.push(format!("({constant:?})"));
            }
            if *by_length != 0.0 {
                terms.push(format!("({by_length:?})*{}", length()));
            }
            if *by_rate != 0.0 {
                terms.push(format!("({by_rate:?})*{}", rate()));
            }
            terms.join(" + ")
        }
        ActuatorLaw::Position { kp, kv } if source.acts(kv) => {
            format!("{}*({u} - {}) - {}*{}", number(kp), length(), number(kv), rate())
        }
        ActuatorLaw::Position { kp, .. } => format!("{}*({u} - {})", number(kp), length()),
        ActuatorLaw::Velocity { kv } => format!("{}*({u} - {})", number(kv), rate()),
        ActuatorLaw::Damper { kv } => format!("-{}*{u}*{}", number(kv), rate()),
    };
    if let Some([lower, upper]) = actuator.force {
        force = format!("clamp({force}, {lower:?}, {upper:?})");
    }
    let force = if gear == Value::Number(1.0).text() { force } else { format!("{gear}*({force})") };
    if force == "0" { Vec::new() } else { shares(source, &actuator.name, &actuator.on, &force, span) }
}
