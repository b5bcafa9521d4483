//! Equation: any holonomic constraint, drivers included.

use symdiff::Formula;

use super::Joint;

/// left = right, formulas of coordinates, points, parameters and t.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The left side.
    pub left: Formula,
    /// The right side, of the same dimension.
    pub right: Formula,
}

impl Joint for Equation {
    fn equation(&self) -> Option<[&Formula; 2]> {
        Some([&self.left, &self.right])
    }
}
