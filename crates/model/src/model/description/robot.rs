//! The links and joints of a URDF, as the file has them.

use crate::grammar::{JointCoordinate, PointRef};

/// The links and joints of a URDF, which the bodies and joints of the model were made of.
#[derive(Clone, Debug)]
pub struct RobotTree {
    /// As the file calls it.
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
    /// Its frame; absent where the link is left out.
    pub place: Option<PointRef>,
    /// The joint that leads to it; absent for the root.
    pub joint: Option<TreeJoint>,
    /// Appearance.
    pub visuals: Vec<Visual>,
}

/// A part of what a link looks like.
#[derive(Clone, Debug)]
pub struct Visual {
    /// Where it is in the link's frame, m.
    pub xyz: [f64; 3],
    /// How it is turned there: rad about the fixed x, y, z.
    pub rpy: [f64; 3],
    /// Its shape, in the middle of its frame.
    pub shape: Shape,
    /// Red, green and blue from 0 to 1.
    pub color: Option<[f64; 3]>,
}

/// A shape; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Its sides along x, y and z.
    Box([f64; 3]),
    /// About z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length.
        length: f64,
    },
    /// Its radius.
    Sphere(f64),
    /// Of a file.
    Mesh {
        /// As the robot's file names it.
        file: String,
        /// Factors along x, y and z.
        scale: [f64; 3],
    },
}

/// A joint of a URDF.
#[derive(Clone, Debug)]
pub struct TreeJoint {
    /// Its name in formulas.
    pub name: String,
    /// The file's word for it.
    pub kind: &'static str,
    /// In the child's frame, where the joint has one coordinate.
    pub axis: Option<[f64; 3]>,
    /// Smallest and largest position, where there is one.
    pub limits: [Option<f64>; 2],
    /// What its position is.
    pub coordinate: JointCoordinate,
    /// N m s/rad or N s/m
    pub damping: f64,
    /// N m or N
    pub friction: f64,
    /// The joint that it follows.
    pub mimics: Option<String>,
}
