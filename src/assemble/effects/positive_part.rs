//! The positive part of a number, with a parabola in place of its corner.
//!
//! ```text
//! p(x) = (⟨x + ε⟩² − ⟨x − ε⟩²)/4ε,   ⟨x⟩ = max(x, 0):   0 below −ε, x above ε, (x + ε)²/4ε between
//! ```
//!
//! p has a continuous slope, which is what Newton's iteration asks for, and is exactly zero where nothing acts.

use symdiff::{Builder, Expr};

/// p, its slope and its integral.
#[derive(Clone, Copy, Debug)]
pub struct PositivePart {
    pub value: Expr,
    pub slope: Expr,
    pub integral: Expr,
}

/// max(x, 0).
pub fn clipped(g: &Builder, x: Expr) -> Expr {
    g.only_where(x, x)
}

impl PositivePart {
    /// Of x, with a corner ε wide to either side.
    pub fn of(g: &Builder, x: Expr, corner: Expr) -> Self {
        let (above, below) = (g.add(x, corner), g.sub(x, corner));
        let (above, below) = (clipped(g, above), clipped(g, below));
        let difference = |power: i32, divisor: f64| {
            let (high, low) = (g.powi(above, power), g.powi(below, power));
            let difference = g.sub(high, low);
            let divisor = g.scale(divisor, corner);
            g.div(difference, divisor)
        };
        Self { slope: difference(1, 2.0), value: difference(2, 4.0), integral: difference(3, 12.0) }
    }
}
