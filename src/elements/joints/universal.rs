//! Universal joint: two points coincide, and an axis of the first frame stays perpendicular to one of the second.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// Two points coincide, and an axis of the first frame stays perpendicular to one of the second.
#[derive(Clone, Debug)]
pub struct Universal {
    /// A and B.
    pub between: [PointRef; 2],
    /// The arms of the cross: a direction in the first frame, and one in the second.
    pub axes: [[Formula; 3]; 2],
}

impl Joint for Universal {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::AboutAxis })
    }
}
