//! Constants of the room `simulate: statics`.

use symdiff::constants::tuning;

tuning! {
    /// Positions of equilibrium.
    "simulate: statics" {
        /// Corrections before it is given up.
        max_corrections: usize = 400, moves "which equilibria are found";
        /// Corrections of a coordinate, in its scale, that are taken as Newton's method says.
        near_correction: f64 = 0.1, moves "which equilibria are found";
        /// Longest correction of a coordinate, in its scale.
        longest_correction: f64 = 0.3, moves "which equilibria are found";
        /// Corrections below this end the iteration.
        settled: f64 = 1e-14, moves "which equilibria are found";
        /// Corrections below this that no longer shrink are round-off.
        stalled: f64 = 1e-9, moves "which equilibria are found";
        /// Stiffnesses, and forces, below this share of the largest are zero.
        zero_stiffness: f64 = 1e-10, moves "which equilibria are found";
        /// Times that a correction is halved at most.
        most_halvings: u32 = 30, moves "which equilibria are found";
        /// Steps from the nominal parameters to those of a sample that is far from them.
        continuation_steps: usize = 16, moves "which equilibria are found";
        /// A sample whose coordinates lie further than this from the nominal ones, in their scales, is reached by
        /// small changes.
        far_sample: f64 = 0.25, moves "which equilibria are found";
        /// Pivots of the equations below this share of the largest are zero: an indifferent coordinate has no jet of
        /// its own.
        singular_pivot: f64 = 1e-10, moves "which equilibria have jets";
        /// Eigenvalues below this share of the largest are zero.
        indifferent_eigenvalue: f64 = 1e-9, moves "which equilibria count as stable";
        /// Share of M's trace that motions without mass get.
        least_mass: f64 = 1e-12, moves "which equilibria count as stable";
    }
}
