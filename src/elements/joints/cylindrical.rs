//! Cylindrical joint: the second point slides along an axis of the first frame, and the frames turn about it.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Mobilizer, Orientation, Placement, Separation};

/// The second point moves along the axis through the first, and the frames turn about it.
#[derive(Clone, Debug)]
pub struct Cylindrical {
    /// A and B.
    pub between: [PointRef; 2],
    /// Direction in both frames.
    pub axis: [Formula; 3],
}

impl Joint for Cylindrical {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::RotationAndTranslation { axis: &self.axis })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }
}
