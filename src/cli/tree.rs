//! The tree of a robot's links and joints, for `mbint check`.

use std::fmt::Write as _;

use crate::grammar::JointCoordinate;
use crate::model::{Description, ParameterValue, TreeJoint, TreeLink};

/// A line for each link: the joint that leads to it, its mass, and the uncertain values of both. Empty if there is no
/// robot.
pub(super) fn of(model: &Description) -> String {
    let Some(robot) = &model.robot else { return String::new() };
    let mut text = String::new();
    for link in &robot.links {
        let indent = "  ".repeat(link.depth + 1);
        let joint = link.joint.as_ref().map_or_else(String::new, joint);
        let mass = link.mass.map_or_else(String::new, |mass| format!(", {mass} kg"));
        let left_out = if link.place.is_none() { ", omitted" } else { "" };
        // Writing to a `String` does not fail.
        let _ = writeln!(text, "{indent}{}{mass}{left_out}{joint}{}", link.name, uncertain(model, link));
    }
    text
}

fn joint(joint: &TreeJoint) -> String {
    let mut text = format!(" ← {} ({}", joint.name, joint.kind);
    let (preposition, unit) = match joint.coordinate {
        JointCoordinate::Angle => ("about", "rad"),
        JointCoordinate::Displacement => ("along", "m"),
    };
    if let Some([x, y, z]) = joint.axis {
        let _ = write!(text, " {preposition} {x} {y} {z}");
    }
    let _ = match joint.limits.map(|limit| limit.filter(|_| joint.axis.is_some())) {
        [Some(lower), Some(upper)] => write!(text, ", {lower} to {upper} {unit}"),
        [Some(lower), None] => write!(text, ", from {lower} {unit}"),
        [None, Some(upper)] => write!(text, ", up to {upper} {unit}"),
        [None, None] => Ok(()),
    };
    for (what, value) in [("damping", joint.damping), ("friction", joint.friction)] {
        if value != 0.0 {
            let _ = write!(text, ", {what} {value}");
        }
    }
    if let Some(other) = &joint.mimics {
        let _ = write!(text, ", mimics {other}");
    }
    text + ")"
}

/// Intervals of the link's numbers and of its joint's.
fn uncertain(model: &Description, link: &TreeLink) -> String {
    let owners =
        [Some(format!("link.{}.", link.name)), link.joint.as_ref().map(|joint| format!("joint.{}.", joint.name))];
    let mut text = String::new();
    for parameter in &model.parameters {
        let owned = owners.iter().flatten().any(|owner| parameter.name.starts_with(owner));
        if let (true, ParameterValue::Interval { lower, upper, .. }) = (owned, &parameter.value) {
            let _ = write!(text, "; {} in [{lower}, {upper}] {}", parameter.name, parameter.unit);
        }
    }
    text
}
