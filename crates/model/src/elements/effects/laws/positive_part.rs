//! The positive part of a number, with a parabola in place of its corner.
//!
//! ```text
//! p(x) = (⟨x + ε⟩² − ⟨x − ε⟩²)/4ε,   ⟨x⟩ = max(x, 0):   0 below −ε, x above ε, (x + ε)²/4ε between
//! ```
//!
//! p has a continuous derivative, as Newton's iteration needs, and is exactly zero where nothing acts.

use symdiff::Scalar;

/// p, its derivative and its integral.
#[derive(Clone, Copy, Debug)]
pub struct PositivePart<'g> {
    pub value: Scalar<'g>,
    pub derivative: Scalar<'g>,
    pub integral: Scalar<'g>,
}

/// max(x, 0).
pub fn clipped(x: Scalar) -> Scalar {
    x.only_where(x)
}

impl<'g> PositivePart<'g> {
    /// Positive part of x, with a corner ε wide to either side.
    pub fn of(x: Scalar<'g>, corner: Scalar<'g>) -> Self {
        let (above, below) = (clipped(x + corner), clipped(x - corner));
        let difference = |power: i32, divisor: f64| (above.powi(power) - below.powi(power)) / (divisor * corner);
        Self { derivative: difference(1, 2.0), value: difference(2, 4.0), integral: difference(3, 12.0) }
    }
}
