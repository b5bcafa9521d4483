//! Constants of the room `simulate: step`.

use symdiff::constants::tuning;

tuning! {
    /// Newton's iteration of a step.
    "simulate: step" {
        /// Corrections with the step's first factorisation before each gets its own.
        frozen_corrections: usize = 4, moves "results within the iteration's tolerance, and time";
        /// Corrections of a step before its iteration is given up.
        max_corrections: usize = 12, moves "results within the iteration's tolerance, and time";
        /// Error of positions at which the iteration ends, relative to the coordinate's scale: the last correction in
        /// position units times the observed contraction.
        tolerance: f64 = 1e-11, moves "results within the iteration's tolerance, and time";
        /// Error of positions at which a first correction ends the iteration: its contraction is only estimated. The
        /// remaining error is noise in the response as a function of the parameters. Against a run that always takes
        /// two corrections, the slider crank's Chebyshev bounds over 2 s change by 2e-12 m at 1e-15, 3e-11 at 1e-14,
        /// 2e-9 at 1e-13; those of Taylor by 2e-9 at 1e-14.
        first_tolerance: f64 = 1e-14, moves "results within the iteration's tolerance, and time";
        /// Contraction that is assumed of a first correction where none was observed.
        first_contraction: f64 = 0.1, moves "results within the iteration's tolerance, and time";
        /// The estimated contraction of a first correction is this times the one last observed of its lane.
        contraction_safety: f64 = 10.0, moves "results within the iteration's tolerance, and time";
        /// Least estimated contraction of a first correction.
        least_contraction: f64 = 1e-9, moves "results within the iteration's tolerance, and time";
        /// After this many steps the observed contraction is discarded, so that it is observed again.
        steps_between_looks: u64 = 16, moves "results within the iteration's tolerance, and time";
        /// Singular values below this share of the largest count as zero.
        zero_singular_value: f64 = 1e-9, moves "steps at singular positions";
        /// A pivot is eliminated sparsely if it is at least the first in the scaled matrix, and the second against its
        /// row.
        safe_pivot: (f64, f64) = (1e-3, 0.1), moves "steps at singular positions";
        /// Corrections below this (relative positions) are round-off, whatever their contraction.
        round_off: f64 = 4.0 * f64::EPSILON, moves "which steps count as converged";
        /// Corrections up to this (relative positions) may be rounding over the distance to a singular position, if
        /// constraints hold.
        stalled: f64 = 1e-10, moves "which steps count as converged";
        /// A step that fails is divided into 2, 4, … substeps, up to 2 to the power of this, before it is given up.
        max_halvings: u32 = 10, moves "which steps are given up";
    }
}
