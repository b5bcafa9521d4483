//! Sources of a robot's bodies, joints and start values: its numbers, frames, and the locations of its parts in the
//! model.

use std::collections::HashSet;

use symdiff::Formula;

use crate::grammar::{JointCoordinate, PointRef, Rotation};
use crate::model::description::Point;
use crate::model::names::Reader;
use crate::robots::algebra::{Pose, Value, Vector};
use crate::robots::names;
use crate::robots::number::Number;
use crate::robots::urdf::robot::{Joint, Robot, UrdfJointType};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;

/// Parsed URDF, and the treatment of its numbers.
pub struct ParsedUrdf<'s> {
    pub robot: &'s Robot,
    pub floating: bool,
    /// Words of the model that names the file.
    pub words: &'s HashSet<String>,
    /// Numbers that are parameters.
    pub named: &'s HashSet<String>,
}

impl ParsedUrdf<'_> {
    pub fn value(&self, number: &Number) -> Value {
        if self.named.contains(&number.name) { Value::Text(number.name.clone()) } else { Value::Number(number.value) }
    }

    pub fn vector(&self, numbers: &[Number; 3]) -> Vector {
        numbers.each_ref().map(|number| self.value(number))
    }

    /// Whether a link of some has mass or inertia.
    pub fn has_inertia(&self, links: &[usize]) -> bool {
        let inertials = links.iter().filter_map(|&link| self.robot.links[link].inertial.as_ref());
        inertials.flat_map(|own| std::iter::once(&own.mass).chain(&own.inertia)).any(|number| number.value != 0.0)
    }

    /// Whether a joint makes its links one body: a fixed one whose reaction the model does not speak of.
    pub fn welds(&self, joint: &Joint) -> bool {
        joint.kind == UrdfJointType::Fixed && !names::is_reaction_asked(self.words, &joint.name)
    }
}

/// Where everything of the robot is in the model.
pub struct Built {
    /// Per joint of the robot, the model's joint; `None` if it does not move or is omitted.
    pub joints: Vec<Option<usize>>,
    /// Per link, its body and its pose in it.
    pub places: Vec<(Option<usize>, Pose)>,
    /// Per link, its frame as others can name it; `None` if it is omitted.
    pub frames: Vec<Option<PointRef>>,
}

/// The formula of a value that is not too long.
pub fn formula(reader: &mut Reader, value: &Value) -> Formula {
    value.formula().unwrap_or_else(|| {
        let message = "too many links are welded together with uncertain numbers";
        reader.diagnostics.push(Diagnostic::of_file(Code::TooLarge, message));
        Formula::number(f64::NAN)
    })
}

pub fn formulas<const N: usize>(reader: &mut Reader, values: &[Value; N]) -> [Formula; N] {
    values.each_ref().map(|value| formula(reader, value))
}

/// A point at a pose, with its frame.
pub fn point(reader: &mut Reader, name: String, pose: &Pose) -> Point {
    let position = formulas(reader, &pose.position);
    let rotation = Some(Rotation::Quaternion(formulas(reader, &pose.rotation)));
    Point { name, position, rotation }
}

/// The coordinate of a joint that has one, and the names of it and its rate.
pub fn coordinate(kind: UrdfJointType) -> Option<(JointCoordinate, &'static str, &'static str)> {
    match kind {
        UrdfJointType::Revolute | UrdfJointType::Continuous => {
            Some((JointCoordinate::Angle, "angle", "angular_velocity"))
        }
        UrdfJointType::Prismatic => Some((JointCoordinate::Displacement, "displacement", "velocity")),
        _ => None,
    }
}
