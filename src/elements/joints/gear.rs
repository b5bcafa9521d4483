//! Gear: two angles in a fixed ratio.

use symdiff::Formula;

use crate::grammar::{Turning, JointCoordinate, OnJoint};

use super::Joint;

/// angle of the second = ratio · angle of the first + offset.
#[derive(Clone, Debug)]
pub struct Gear {
    /// The first and the second.
    pub between: [Turning; 2],
    /// Negative for an external pair.
    pub ratio: Formula,
    /// rad
    pub offset: Formula,
}

impl Joint for Gear {
    fn coordinates(&self, _: usize) -> Vec<OnJoint> {
        let of_joint = |angle| match angle {
            Turning::Joint(joint) => Some(OnJoint { joint, coordinate: JointCoordinate::Angle }),
            Turning::Body(_) => None,
        };
        self.between.into_iter().filter_map(of_joint).collect()
    }
}
