//! Start of a robot: the file's configuration, where the model gives none; and its default outputs.

use std::collections::HashSet;

use super::build::PlacedRobot;
use super::tree::{Sections, keys, text, value, values};
use crate::robots::algebra::{Pose, Value};
use crate::robots::mjcf::robot::{Coupling, MjcfType};
use crate::syntax::yaml::Value as Tree;

/// Adds start values, or guesses, from which assembly finds them; it also finds joints that equalities constrain.
pub fn start(sections: &mut Sections, source: &PlacedRobot) {
    let robot = source.robot;
    let said = said(sections);
    // A start at equilibrium gives no values.
    let is_found = sections
        .0
        .iter()
        .any(|entry| entry.key == "initial" && entry.value.scalar().is_some_and(|scalar| !scalar.is_null()));
    let loops = |coupling: &Coupling| matches!(coupling, Coupling::Connect(_) | Coupling::Weld(_));
    let is_closed = robot.equalities.iter().any(|equality| loops(&equality.what));
    let mut followers = HashSet::new();
    for equality in &robot.equalities {
        if let Coupling::Polynomial { first, .. } = &equality.what {
            followers.extend(first.terms.iter().map(|(joint, _)| *joint));
        }
    }
    let mut poses = vec![Pose::identity()];
    for (index, body) in robot.bodies.iter().enumerate().skip(1) {
        let position = body.position.each_ref().map(|number| Value::Number(number.value));
        let pose = poses[body.parent].then(&position, &body.rotation);
        let kind = |kind| body.joints.iter().any(|&joint| robot.joints[joint].kind == kind);
        if (kind(MjcfType::Free) || kind(MjcfType::Ball)) && !said.contains(&body.name) {
            let section = if kind(MjcfType::Free) && !is_closed && !is_found { "initial" } else { "guess" };
            for (axis, position) in ["x", "y", "z"].into_iter().zip(&pose.position) {
                sections.add(section, &format!("{}.{axis}", body.name), value(&body.span, position));
            }
            let rotation = keys(&body.span, [("quaternion", values(&body.span, &pose.rotation))]);
            sections.add(section, &format!("{}.orientation", body.name), rotation);
        }
        poses.push(pose);
        debug_assert_eq!(poses.len(), index + 1);
    }
    for (index, joint) in robot.joints.iter().enumerate() {
        if joint.is_single() && !said.contains(&joint.name) && !is_found && !is_closed && !followers.contains(&index) {
            sections.add("initial", &joint.coordinate(false), text(&joint.span, "0"));
        }
    }
    if is_closed || is_found {
        guesses(sections, source, &poses);
    }
}

/// Adds guesses: the positions from which assembly starts its search, for every body.
fn guesses(sections: &mut Sections, source: &PlacedRobot, poses: &[Pose]) {
    for (index, body) in source.robot.bodies.iter().enumerate().skip(1) {
        if source.holders[index].0 != index {
            continue;
        }
        let mut add = |name: &str| {
            for (axis, position) in ["x", "y", "z"].into_iter().zip(&poses[index].position) {
                sections.add("guess", &format!("{name}.{axis}"), value(&body.span, position));
            }
            let rotation = keys(&body.span, [("quaternion", values(&body.span, &poses[index].rotation))]);
            sections.add("guess", &format!("{name}.orientation"), rotation);
        };
        add(&body.name);
        if let [before @ .., _] = body.joints.as_slice() {
            before.iter().for_each(|&joint| add(&format!("{}_{}", body.name, source.robot.joints[joint].name)));
        }
    }
}

/// Bodies and joints of which the model says where they begin.
fn said(sections: &Sections) -> HashSet<String> {
    let mut said = HashSet::new();
    for section in sections.0.iter().filter(|entry| matches!(entry.key.as_str(), "initial" | "guess")) {
        let Tree::Mapping(entries) = &section.value.value else { continue };
        for entry in entries {
            if let Some((owner, member)) = entry.key.split_once('.')
                && !matches!(member, "velocity" | "angular_velocity" | "vx" | "vy" | "vz")
            {
                said.insert(owner.to_owned());
            }
        }
    }
    said
}

/// Adds outputs if the model has none: positions of joints and of free bodies, and angles of balls.
pub fn outputs(sections: &mut Sections, source: &PlacedRobot) {
    if sections.0.iter().any(|entry| entry.key == "outputs" && !entry.value.is_null()) {
        return;
    }
    for joint in &source.robot.joints {
        if joint.is_single() {
            sections.add("outputs", &joint.name, text(&joint.span, joint.coordinate(false)));
            continue;
        }
        let body = &source.robot.bodies[joint.body];
        let members = if joint.kind == MjcfType::Free { ["x", "y", "z"] } else { ["roll", "pitch", "yaw"] };
        for member in members {
            let name = format!("{}_{member}", body.name);
            sections.add("outputs", &name, text(&joint.span, format!("{}.{member}", body.name)));
        }
    }
}
