//! Joints of a [`Robot`](crate::robots::urdf::robot::Robot) → joints of the model.

use symdiff::Formula;

use super::source::{Built, ParsedUrdf, coordinate, formula, point};
use crate::elements::joints::{Equation, Fixed, Gear, JointKind, Planar, Prismatic, Revolute};
use crate::grammar::{Axis, Direction, PointRef, Rotating};
use crate::model::description::Joint;
use crate::model::names::Reader;
use crate::robots::algebra::{self, Value};
use crate::robots::urdf::robot::UrdfJointType;

/// Adds a joint that moves, or a fixed one whose reaction the model asks for, with its frame on its parent.
pub fn joint(reader: &mut Reader, source: &ParsedUrdf, built: &Built, index: usize) -> Option<usize> {
    let joint = &source.robot.joints[index];
    let (parent, pose) = &built.places[joint.parent];
    let (parent, child) = ((*parent)?, built.places[joint.child].0?);
    if joint.kind == UrdfJointType::Floating || source.welds(joint) {
        return None;
    }
    let rotation = algebra::roll_pitch_yaw(&source.vector(&joint.origin.rpy));
    let pose = pose.then(&source.vector(&joint.origin.xyz), &rotation);
    let mut name = joint.name.clone();
    while reader.model.bodies[parent].points.iter().any(|point| point.name == name) {
        name.push_str("_joint");
    }
    let at = point(reader, name, &pose);
    let points = &mut reader.model.mechanism_mut().bodies[parent].points;
    points.push(at);
    let between = [PointRef { body: parent, point: Some(points.len() - 1) }, PointRef { body: child, point: None }];
    let axis = unit(joint.axis).map(Formula::number);
    let kind: JointKind = match joint.kind {
        UrdfJointType::Prismatic => Prismatic { between, axis: Direction(axis), angle: Formula::number(0.0) }.into(),
        UrdfJointType::Fixed => Fixed { between, angle: Formula::number(0.0) }.into(),
        UrdfJointType::Planar => Planar { between, normal: Direction(axis) }.into(),
        _ => Revolute { between, axis: Axis(axis) }.into(),
    };
    reader.model.mechanism_mut().joints.push(Joint::new(joint.name.clone(), kind));
    Some(reader.model.joints.len() - 1)
}

/// Scales a vector to length one.
fn unit(axis: [f64; 3]) -> [f64; 3] {
    let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    axis.map(|part| part / length)
}

/// Adds the constraint of a joint that mimics another.
pub fn mimic(reader: &mut Reader, source: &ParsedUrdf, built: &Built, index: usize) {
    let joint = &source.robot.joints[index];
    let Some(mimic) = &joint.mimic else { return };
    let (Some(this), Some(other)) = (built.joints[index], built.joints[mimic.joint]) else { return };
    let leader = &source.robot.joints[mimic.joint];
    let (Some((_, position, _)), Some((_, followed, _))) = (coordinate(joint.kind), coordinate(leader.kind)) else {
        return;
    };
    let kind = if joint.kind.turns() && leader.kind.turns() && mimic.multiplier != 0.0 {
        let between = [Rotating::Joint(other), Rotating::Joint(this)];
        JointKind::from(Gear::of(between, mimic.multiplier, mimic.offset))
    } else {
        let text = format!("({:e})*{}.{followed} + ({:e})", mimic.multiplier, leader.name, mimic.offset);
        JointKind::from(Equation {
            left: formula(reader, &Value::Text(format!("{}.{position}", joint.name))),
            right: formula(reader, &Value::Text(text)),
        })
    };
    let mut name = format!("{}_mimic", joint.name);
    while reader.model.joints.iter().any(|joint| joint.name == name) {
        name.push('_');
    }
    reader.model.mechanism_mut().joints.push(Joint::new(name, kind));
}
