//! Constants of the room `simulate: statics`.

use symdiff::constants::tuning;

tuning! {
    /// Positions of equilibrium.
    "simulate: statics" {
        /// Corrections of an equilibrium before it is given up.
        max_corrections: usize = 400, moves "which equilibria are found";
        /// Corrections of a coordinate, in its scale, that are taken as Newton's method says.
        near_correction: f64 = 0.1, moves "which equilibria are found";
        /// Longest correction of a coordinate, in its scale.
        longest_correction: f64 = 0.3, moves "which equilibria are found";
        /// Corrections below this that no longer shrink are round-off.
        stalled: f64 = 1e-9, moves "which equilibria are found";
        /// Stiffnesses, and forces, below this share of the largest are zero.
        zero_stiffness: f64 = 1e-10, moves "which equilibria are found";
        /// Times that a correction is halved at most.
        most_halvings: u32 = 30, moves "which equilibria are found";
        /// Pivots of the equations below this share of the largest are zero: an indifferent coordinate has no jet of
        /// its own.
        singular_pivot: f64 = 1e-10, moves "which equilibria have jets";
        /// Eigenvalues below this share of the largest are zero.
        indifferent_eigenvalue: f64 = 1e-9, moves "which equilibria count as stable";
    }
}
