//! Pin in slot: the second point slides along a line fixed in the first body, and may turn about the frames' z.

use symdiff::Formula;

use crate::grammar::PointRef;

use super::{Joint, Orientation, Placement, Separation};

/// The second point moves along a line through the first, fixed in the first body, and may turn about the frames' z.
#[derive(Clone, Debug)]
pub struct PinInSlot {
    /// A point of the slot's line, and the pin.
    pub between: [PointRef; 2],
    /// Direction of the slot in the first frame.
    pub axis: [Formula; 3],
}

impl Joint for PinInSlot {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }
}
