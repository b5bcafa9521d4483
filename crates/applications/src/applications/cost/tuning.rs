//! Constants of the room `applications: cost`.

use symdiff::constants::tuning;

tuning! {
    /// The work-precision study of a model.
    "applications: cost" {
        /// An output that moves (or whose band gets wider) by no more than this share of its size has no scale to
        /// measure by.
        at_rest: f64 = 1e-9, moves "which outputs count in cost studies";
        /// Steps, in parts of the model's own.
        parts_of_step: [f64; 6] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0], moves "which settings a cost study runs";
        /// Tolerances of the explicit method.
        tolerances: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8], moves "which settings a cost study runs";
        /// Orders of bounds whose samples are integrated in place of plain steps: more accurate samples are worth
        /// higher ones.
        orders_of_accurate_samples: [usize; 4] = [5, 8, 12, 16], moves "which settings a cost study runs";
        /// Spectral radii that generalised-α is tried with.
        spectral_radii: [f64; 3] = [0.5, 0.8, 0.9], moves "which settings a cost study runs";
        /// Share of the progress bar at which the reference is done.
        reference_done: f64 = 0.3, moves "the progress bar";
        /// Share of the progress bar at which the bounds are done.
        bounds_done: f64 = 0.95, moves "the progress bar";
        /// Share of the budget that is reserved for the schemes on the nominal trajectory.
        for_schemes: f64 = 0.2, moves "which settings a cost study runs";
        /// Most time that is reserved for the schemes on the nominal trajectory, s.
        most_for_schemes: f64 = 5.0, moves "which settings a cost study runs";
        /// Highest orders of the reference for one, two and three parameters.
        highest_orders: [usize; 3] = [32, 24, 10], moves "the reference of a cost study";
        /// Highest order for more parameters, if the simulations allow it.
        order_of_many: usize = 7, moves "the reference of a cost study";
        /// The order is not lowered below this for the time's sake, nor the steps made coarser.
        least_order: usize = 2, moves "the reference of a cost study";
        /// Simulations of one run of the reference.
        most_simulations: f64 = 1e4, moves "the reference of a cost study";
        /// Refinements of the reference's finest steps, relative to the model's.
        finer_references: [f64; 5] = [16.0, 8.0, 4.0, 2.0, 1.0], moves "the reference of a cost study";
        /// Points of the dense scan, a parameter, for one, two and three: odd, so that every second of them makes a
        /// scan too.
        dense_scans: [[usize; 3]; 3] = [[401, 201, 101], [61, 41, 21], [21, 13, 9]],
            moves "the reference of a cost study";
        /// Points of a scan that measures the time of many samples.
        trial_scans: [usize; 3] = [64, 8, 4], moves "the reference of a cost study";
        /// The coarsest reference may take this share; with more, nothing would be left to compare with it.
        most_of_coarsest: f64 = 0.7, moves "the reference of a cost study";
        /// The effect of orders is only measured if a short run takes less than this share.
        share_of_trial: f64 = 0.05, moves "the reference of a cost study";
        /// Share of the budget that the reference's surrogate may take.
        share_of_reference: f64 = 0.35, moves "the reference of a cost study";
        /// Share of the budget that the reference's scan may take.
        share_of_scan: f64 = 0.25, moves "the reference of a cost study";
        /// Time after which a run is not repeated again, s.
        long_enough: f64 = 0.15, moves "times in cost studies";
        /// Most repetitions of a run.
        often_enough: usize = 5, moves "times in cost studies";
    }
}
