//! Spherical joint: two points coincide.

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// Two points coincide.
#[derive(Clone, Debug)]
pub struct Spherical {
    /// A and B.
    pub between: [PointRef; 2],
}

impl Joint for Spherical {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::Free })
    }
}
