//! Points and frames fixed in bodies.

use super::rotation::Quaternion;
use super::space::Vector;

/// A point fixed in a body.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPoint {
    /// Index of the body.
    pub body: usize,
    /// R s: from the frame's origin to the point, in the ground's frame.
    pub arm: Vector,
    /// r
    pub position: Vector,
    /// ṙ
    pub velocity: Vector,
}

/// A frame fixed in a body.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Its origin.
    pub point: MaterialPoint,
    /// Its orientation against the ground.
    pub orientation: Quaternion,
}
