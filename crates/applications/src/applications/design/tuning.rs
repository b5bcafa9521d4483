//! Constants of the room `applications: design`.

use symdiff::constants::tuning;

tuning! {
    /// Nominal values that a study chooses.
    "applications: design" {
        /// Digits of a nominal value that was found, of the range's width.
        digits: i32 = 4, moves "nominal values that are found";
        /// Parameters of which both neighbours are tried.
        rounded_parameters: usize = 5, moves "nominal values that are found";
        /// Error relative to an output's range that the surrogate aims at, if the model asks for none.
        tolerance: f64 = 1e-3, moves "nominal values that are found";
        /// Shares of the largest margin without tolerances at which the cost is reported.
        traded: [f64; 4] = [0.2, 0.4, 0.6, 0.8], moves "the list of costs beside margins";
        /// Violations that differ by less are equal, and a smaller one is none: shares of limits.
        equal_violations: f64 = 1e-9, moves "nominal values that are found";
        /// Most instants of a requirement.
        instants: usize = 33, moves "nominal values that are found";
        /// Optima that are reported at most.
        reported: usize = 3, moves "the list of optima";
        /// Largest multiple of the model's tolerances that is allocated.
        widest: f64 = 3.0, moves "the list of optima";
        /// Half of the region, as a share of the ranges, of the surrogate that determines a quantile.
        region_of_quantile: f64 = 1e-3, moves "which margins count as missed";
        /// A margin that is missed by less is left.
        missed_margin: f64 = 1e-9, moves "which margins count as missed";
        /// Rounds in which a step's costs get their tangents.
        rounds_of_tangents: usize = 12, moves "tolerances that are found with nominal values";
        /// Share of the cost that a tangent may leave.
        left_by_tangents: f64 = 1e-7, moves "tolerances that are found with nominal values";
        /// Most times that tolerances are tightened until a point leaves its margin.
        tightened: usize = 6, moves "tolerances that are found with nominal values";
        /// Points of a profile.
        points_of_profile: usize = 41, moves "profiles of the objective";
        /// Narrower regions, as shares of the ranges to either side.
        regions: [f64; 2] = [0.12, 0.03], moves "nominal values that are found";
        /// Times that a narrower region is tried while the optimum is at its edge.
        moves: usize = 8, moves "nominal values that are found";
        /// An optimum nearer to the edge of a region than this share of it is on it.
        edge: f64 = 1e-3, moves "nominal values that are found";
        /// Reserve of a requirement, in multiples of the violation in a study.
        reserved: f64 = 1.2, moves "nominal values that are found";
        /// Studies that correct the surrogate, at most.
        corrections: usize = 4, moves "nominal values that are found";
        /// Starts that are compared, for each free parameter.
        starts_a_parameter: usize = 16, moves "nominal values that are found";
        /// Most starts that are compared.
        most_starts: usize = 96, moves "nominal values that are found";
        /// Starts that are followed, in addition to those that are known.
        followed_starts: usize = 4, moves "nominal values that are found";
        /// First trust region, in shares of the region.
        first_radius: f64 = 0.2, moves "nominal values that are found";
        /// Largest trust region, in shares of the region.
        largest_radius: f64 = 0.5, moves "nominal values that are found";
        /// Trust region at which a search over whole ranges ends, in shares of the region.
        rough_end: f64 = 1e-3, moves "nominal values that are found";
        /// Trust region at which a search ends that makes an optimum sharper, in shares of the region.
        sharp_end: f64 = 1e-4, moves "nominal values that are found";
        /// Corners of the tolerances at which starts are compared.
        corners_of_starts: usize = 16, moves "nominal values that are found";
        /// Factor of the trust region after a step that is better.
        wider: f64 = 1.6, moves "nominal values that are found";
        /// Factor of the trust region after a step that is not better.
        narrower: f64 = 0.4, moves "nominal values that are found";
        /// The trust region when at last nothing may be missed, in multiples of the smallest.
        restored: f64 = 100.0, moves "nominal values that are found";
        /// Weight of a violation, in multiples of the gain of a goal by it.
        price_of_violation: f64 = 5.0, moves "nominal values that are found";
        /// Steps that are tried again with the cases that they showed, before the trust region shrinks.
        tried_again: usize = 4, moves "nominal values that are found";
        /// Most steps of a local search for an optimum.
        steps_of_search: usize = 120, moves "nominal values that are found";
        /// Optima nearer than this, as a share of the region along each axis, are one.
        same_optimum: f64 = 0.02, moves "nominal values that are found";
        /// Samples by which a share of the production is estimated.
        samples_of_share: usize = 1 << 12, moves "nominal values that are found for a yield";
        /// If there is no surrogate over a region, one about the same middle is tried that is this share of it.
        narrower_region: f64 = 0.5, moves "nominal values that are found";
        /// Times that a narrower region is tried if there is no surrogate, at most.
        narrower_regions: usize = 4, moves "nominal values that are found";
        /// Worst cases that are remembered for each requirement.
        remembered: usize = 12, moves "nominal values that are found";
        /// Distance, in ξ, below which two worst cases are one.
        same_case: f64 = 0.05, moves "nominal values that are found";
        /// A difference quotient's step, as a share of the region's width.
        step_of_difference: f64 = 1e-4, moves "nominal values that are found";
    }
}
