//! Rotations of frames, as a model gives them.

use symdiff::Formula;

/// A rotation from one frame to another.
#[derive(Clone, Debug)]
pub enum Rotation {
    /// Turned about the fixed x, then y, then z, rad.
    RollPitchYaw([Formula; 3]),
    /// About an axis of any length but zero, by an angle in rad.
    AxisAngle([Formula; 3], Formula),
    /// Euler parameters p0 to p3, of any length but zero.
    Quaternion([Formula; 4]),
}

impl Rotation {
    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::RollPitchYaw(angles) => angles.iter().collect(),
            Self::AxisAngle(axis, angle) => axis.iter().chain([angle]).collect(),
            Self::Quaternion(p) => p.iter().collect(),
        }
    }
}
