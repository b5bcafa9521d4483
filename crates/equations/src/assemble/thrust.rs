//! Forces at points, as effects apply them.

use symdiff::Scalar;

use crate::multibody::Vector;

/// A force at a point of a body, and its opposite on another, as an effect applies it.
#[derive(Clone, Copy)]
pub struct Thrust<'g> {
    /// The other body and this one; the ground has no picture of a force on it.
    pub bodies: [usize; 2],
    /// The point, in the ground's frame, m.
    pub at: Vector<'g>,
    /// Force in the ground's axes, N.
    pub force: Vector<'g>,
    /// It acts only where this is positive.
    pub condition: Option<Scalar<'g>>,
}
