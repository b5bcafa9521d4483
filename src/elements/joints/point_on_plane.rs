//! Point on plane: the second point moves in a plane fixed in the first body; the bodies may turn in any way.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// The second point moves in a plane through the first, fixed in the first body.
#[derive(Clone, Debug)]
pub struct PointOnPlane {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction of the normal in the first frame.
    pub normal: [Formula; 3],
}

impl Joint for PointOnPlane {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Free })
    }
}
