//! Gear: two angles in a fixed ratio.

use symdiff::Formula;

use crate::elements::{AngleOf, JointCoordinate, OnJoint};

use super::Joint;

/// angle of the second = ratio · angle of the first + offset.
#[derive(Clone, Debug)]
pub struct Gear {
    /// The first and the second.
    pub between: [AngleOf; 2],
    /// Negative for an external pair.
    pub ratio: Formula,
    /// rad
    pub offset: Formula,
}

impl Joint for Gear {
    fn coordinates(&self, _: usize) -> Vec<OnJoint> {
        let of_joint = |angle| match angle {
            AngleOf::Joint(joint) => Some(OnJoint { joint, coordinate: JointCoordinate::Angle }),
            AngleOf::Body(_) => None,
        };
        self.between.into_iter().filter_map(of_joint).collect()
    }
}
