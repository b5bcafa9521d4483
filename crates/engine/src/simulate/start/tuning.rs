//! Constants of the room `simulate: start`.

use symdiff::constants::tuning;

tuning! {
    /// Assembly of a start.
    "simulate: start" {
        /// Corrections of a tile's start before a lane is given up.
        max_corrections: usize = 40, moves "which mechanisms and samples are assembled";
        /// Damped corrections of the nominal start from one guess.
        max_nominal_corrections: usize = 200, moves "which mechanisms and samples are assembled";
        /// Guesses that are tried for the nominal start: the model's own, then ever wider around it.
        guesses: usize = 60, moves "which mechanisms and samples are assembled";
        /// A constraint holds when its residual is at most this, relative to the smallest coordinate scale (at most
        /// 1).
        closed_constraint: f64 = 1e-9, moves "which mechanisms and samples are assembled";
        /// Corrections towards rest, relative to the coordinates' scales, that are not shortened.
        reach_of_corrections: f64 = 0.3, moves "which mechanisms and samples are assembled";
        /// A sample whose coordinates lie further than this from the nominal ones, in their scales, may be on another
        /// branch: it is reached by small changes.
        far_sample: f64 = 0.25, moves "which samples are assembled, and which equilibria are found";
        /// Distance of pivot samples from the nominal start, in coordinate scales.
        pivot_sample_spread: f64 = 0.7, moves "the choice of pivots";
        /// Distance of a configuration in general position from the start, in coordinate scales.
        apart_from_start: f64 = 0.05, moves "which constraints count as redundant";
        /// Corrections that bring a moved configuration back onto the constraints.
        corrections_of_position: usize = 30, moves "which constraints count as redundant";
        /// Rows of Φ_q that are independent of the others by less than this (scaled) count as dependent.
        dependent_row: f64 = 1e-8, moves "which constraints count as redundant";
        /// Distances from rest below this, in their scales, are round-off.
        at_rest: f64 = 1e-12, moves "starts that are nearest to rest";
        /// Distances from rest above this, in their scales, show that several of them share the open part.
        several_open: f64 = 1e-6, moves "starts that are nearest to rest";
        /// Pivots below this share of the first one count as zero.
        rank_tolerance: f64 = 1e-9, moves "which constraints count as redundant";
        /// A row is distinguished by a column of its own if the entry there is at least this share of its largest.
        own_share: f64 = 1e-3, moves "which constraints count as redundant";
        /// Corrections (relative to the coordinates' scales) that end the iteration.
        settled: f64 = 1e-14, moves "starts and equilibria, within rounding";
        /// Corrections below this that no longer shrink are round-off.
        stalled: f64 = 1e-8, moves "starts, within rounding";
    }
}
