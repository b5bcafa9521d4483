//! Screw joint: a cylindrical joint that advances as it turns.

use symdiff::Formula;

use crate::grammar::{JointCoordinate, OnJoint, PointRef};

use super::{Joint, Mobilizer, Orientation, Placement, Separation};

/// A cylindrical joint that advances by `pitch` in a turn.
#[derive(Clone, Debug)]
pub struct Screw {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction in both frames.
    pub axis: [Formula; 3],
    /// Advance of the second point in a turn, m; positive for a right-handed thread.
    pub pitch: Formula,
}

impl Joint for Screw {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Helix { axis: &self.axis, pitch: &self.pitch })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }

    fn coordinates(&self, own: usize) -> Vec<OnJoint> {
        vec![OnJoint { joint: own, coordinate: JointCoordinate::Angle }]
    }
}
