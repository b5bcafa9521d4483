//! Points and frames fixed in bodies.

use super::rotation::Quaternion;
use super::vector::Vector;

/// A point fixed in a body, in the ground's axes.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPoint<'g> {
    /// Index of the body.
    pub body: usize,
    /// R s: from the origin of the body's frame to the point, m.
    pub arm: Vector<'g>,
    /// r, m
    pub position: Vector<'g>,
    /// ṙ, m/s
    pub velocity: Vector<'g>,
}

/// A frame fixed in a body.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'g> {
    /// Its origin.
    pub point: MaterialPoint<'g>,
    /// Its orientation against the ground.
    pub orientation: Quaternion<'g>,
}
