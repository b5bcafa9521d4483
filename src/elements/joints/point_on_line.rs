//! Point on line: the second point slides along a line fixed in the first body; the bodies may turn in any way.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// The second point moves along a line through the first, fixed in the first body.
#[derive(Clone, Debug)]
pub struct PointOnLine {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction of the line in the first frame.
    pub axis: [Formula; 3],
}

impl Joint for PointOnLine {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Free })
    }
}
