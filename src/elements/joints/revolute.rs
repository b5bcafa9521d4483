//! Revolute joint: two points coincide, and the frames turn about an axis against one another.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Mobilizer, Orientation, Placement, Separation};

/// Two points coincide, and the frames turn about an axis against one another.
#[derive(Clone, Debug)]
pub struct Revolute {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction in both frames; in the plane z.
    pub axis: [Formula; 3],
}

impl Joint for Revolute {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Rotation { axis: &self.axis })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::AboutAxis })
    }
}
