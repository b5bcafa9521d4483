//! The zero configuration of a robot, and its default outputs.

use std::collections::HashSet;

use symdiff::Formula;

use super::source::{Built, ParsedUrdf, coordinate, formula, formulas};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Coordinate, Rotation, TimeOrder};
use crate::model::description::{Output, StartValue};
use crate::model::names::Reader;
use crate::robots::algebra::{self, Pose, Value};
use crate::robots::number::Number;
use crate::robots::urdf::robot::UrdfJointType;

/// Adds the zero configuration, for joints and bodies without a start value in the model.
pub fn start(reader: &mut Reader, source: &ParsedUrdf, built: &Built) {
    let robot = source.robot;
    let mut poses = vec![Pose::identity(); robot.links.len()];
    let said: HashSet<usize> = reader.model.initial.iter().chain(&reader.model.guess).filter_map(joint_of).collect();
    let bodies: HashSet<usize> = reader.model.initial.iter().chain(&reader.model.guess).filter_map(body_of).collect();
    let place = |reader: &mut Reader, body: usize, pose: &Pose, kept: bool| {
        if bodies.contains(&body) {
            return;
        }
        let coordinates = [Coordinate::X, Coordinate::Y, Coordinate::Z];
        let mut values: Vec<StartValue> = Vec::new();
        for (coordinate, value) in coordinates.into_iter().zip(formulas(reader, &pose.position)) {
            values.push(StartValue::Coordinate { body, coordinate, order: TimeOrder::Position, value });
        }
        let rotation = Rotation::Quaternion(formulas(reader, &pose.rotation));
        values.push(StartValue::Orientation { body, rotation });
        if kept {
            reader.model.mechanism_mut().initial.extend(values)
        } else {
            reader.model.mechanism_mut().guess.extend(values)
        }
    };
    if let (true, Some(body)) = (source.floating, built.places[robot.root].0) {
        place(reader, body, &Pose::identity(), true);
    }
    for &index in &robot.order {
        let joint = &robot.joints[index];
        let nominal = |numbers: &[Number; 3]| numbers.each_ref().map(|number| Value::Number(number.value));
        let rotation = algebra::roll_pitch_yaw(&nominal(&joint.origin.rpy));
        poses[joint.child] = poses[joint.parent].then(&nominal(&joint.origin.xyz), &rotation);
        let body = built.places[joint.child].0;
        match (joint.kind, built.joints[index], coordinate(joint.kind), body) {
            (UrdfJointType::Floating, _, _, Some(body)) => place(reader, body, &poses[joint.child], true),
            (UrdfJointType::Planar, Some(_), _, Some(body)) => place(reader, body, &poses[joint.child], false),
            (_, Some(found), Some((coordinate, ..)), _) if joint.mimic.is_none() && !said.contains(&found) => {
                let value = Formula::number(0.0);
                let order = TimeOrder::Position;
                reader.model.mechanism_mut().initial.push(StartValue::Joint { joint: found, coordinate, order, value });
            }
            _ => {}
        }
    }
}

fn joint_of(value: &StartValue) -> Option<usize> {
    match value {
        StartValue::Joint { joint, order: TimeOrder::Position, .. } => Some(*joint),
        _ => None,
    }
}

fn body_of(value: &StartValue) -> Option<usize> {
    match value {
        StartValue::Coordinate { body, order: TimeOrder::Position, .. } | StartValue::Orientation { body, .. } => {
            Some(*body)
        }
        _ => None,
    }
}

/// Adds outputs if the model gives none: the joints' positions, and the positions of floating bodies.
pub fn outputs(reader: &mut Reader, source: &ParsedUrdf, built: &Built) {
    let mut push = |name: String, text: String, dimension: Dimension| {
        let formula = formula(reader, &Value::Text(text));
        reader.model.outputs.push(Output {
            name,
            formula,
            unit: dimension.unit(),
            dimension: Some(dimension),
            of_results: false,
        });
    };
    if source.floating {
        let root = &source.robot.links[source.robot.root].name;
        ["x", "y", "z"]
            .into_iter()
            .for_each(|axis| push(format!("{root}_{axis}"), format!("{root}.{axis}"), Dimension::LENGTH));
    }
    for &index in &source.robot.order {
        let joint = &source.robot.joints[index];
        let child = &source.robot.links[joint.child].name;
        match (coordinate(joint.kind), built.joints[index]) {
            (Some((_, position, _)), Some(_)) => {
                let dimension = if joint.kind.turns() { Dimension::ANGLE } else { Dimension::LENGTH };
                push(joint.name.clone(), format!("{}.{position}", joint.name), dimension);
            }
            (None, _) if joint.kind != UrdfJointType::Fixed && built.places[joint.child].0.is_some() => {
                let mut part =
                    |axis: &str| push(format!("{}_{axis}", joint.name), format!("{child}.{axis}"), Dimension::LENGTH);
                ["x", "y", "z"].into_iter().for_each(&mut part);
            }
            _ => {}
        }
    }
}
