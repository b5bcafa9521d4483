//! Distance joint: two points keep a distance, as if by a massless rod.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// Two points keep a distance.
#[derive(Clone, Debug)]
pub struct Distance {
    /// A and B.
    pub between: [PointRef; 2],
    /// m, positive.
    pub length: Formula,
}

impl Joint for Distance {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Distance(&self.length), orientation: Orientation::Free })
    }
}
