//! Prismatic joint: the second point slides along a line fixed in the first body, without relative rotation.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Mobilizer, Orientation, Placement, Separation};

/// The second point moves along a line through the first, fixed in the first body, without relative rotation.
#[derive(Clone, Debug)]
pub struct Prismatic {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction of the line in the first frame.
    pub axis: [Formula; 3],
    /// Angle of the second frame against the first about the first's z, rad.
    pub angle: Formula,
}

impl Joint for Prismatic {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Translation { axis: &self.axis, twist: &self.angle })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Fixed(&self.angle) })
    }
}
