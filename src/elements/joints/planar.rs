//! Planar joint: the second point moves in a plane fixed in the first body, and the frames turn about its normal.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// The second point moves in a plane through the first, and the frames turn about its normal.
#[derive(Clone, Debug)]
pub struct Planar {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction in both frames.
    pub normal: [Formula; 3],
}

impl Joint for Planar {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }
}
