//! The links and joints of a URDF, as the file has them.

use crate::grammar::{JointCoordinate, PointRef};
use crate::robots::urdf::robot::Visual;

/// The links and joints of a URDF, which the bodies and joints of the model were made of.
#[derive(Clone, Debug)]
pub struct RobotTree {
    /// Name in the file.
    pub name: String,
    /// Each behind its parent.
    pub links: Vec<TreeLink>,
}

/// A link of a URDF.
#[derive(Clone, Debug)]
pub struct TreeLink {
    /// Its name in formulas.
    pub name: String,
    /// Joints between it and the root.
    pub depth: usize,
    /// kg, where the file has one.
    pub mass: Option<f64>,
    /// Its frame; `None` if the link is omitted.
    pub place: Option<PointRef>,
    /// The joint that leads to it; `None` for the root.
    pub joint: Option<TreeJoint>,
    /// Appearance.
    pub visuals: Vec<Visual>,
}

/// A joint of a URDF.
#[derive(Clone, Debug)]
pub struct TreeJoint {
    /// Its name in formulas.
    pub name: String,
    /// The file's word for it.
    pub kind: &'static str,
    /// Axis in the child's frame, if the joint has one coordinate.
    pub axis: Option<[f64; 3]>,
    /// Smallest and largest position; `None` for no limit.
    pub limits: [Option<f64>; 2],
    /// Kind of its position: an angle or a displacement.
    pub coordinate: JointCoordinate,
    /// N m s/rad or N s/m
    pub damping: f64,
    /// N m or N
    pub friction: f64,
    /// The joint that it follows.
    pub mimics: Option<String>,
}
