//! Fixed joint: two bodies are welded.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Mobilizer, Orientation, Placement, Separation};

/// Two points coincide, and the second frame is turned by `angle` about the first's z.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// A and B.
    pub between: [PointRef; 2],
    /// Angle of the second frame against the first about the first's z, rad.
    pub angle: Formula,
}

impl Joint for Fixed {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Weld { twist: &self.angle })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::Fixed(&self.angle) })
    }
}
