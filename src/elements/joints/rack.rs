//! Rack and pinion: a displacement in a fixed ratio to an angle.

use symdiff::Formula;

use crate::grammar::{JointCoordinate, OnJoint};

use super::Joint;

/// displacement of the rack's joint = radius · angle of the pinion's joint + offset.
#[derive(Clone, Debug)]
pub struct Rack {
    /// Joint index.
    pub pinion: usize,
    /// Joint index.
    pub rack: usize,
    /// m a radian
    pub radius: Formula,
    /// m
    pub offset: Formula,
}

impl Joint for Rack {
    fn coordinates(&self, _: usize) -> Vec<OnJoint> {
        vec![
            OnJoint { joint: self.pinion, coordinate: JointCoordinate::Angle },
            OnJoint { joint: self.rack, coordinate: JointCoordinate::Displacement },
        ]
    }
}
