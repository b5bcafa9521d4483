//! Constants of the room `applications: fit`.

use symdiff::constants::tuning;

tuning! {
    /// Parameters that agree with measured values.
    "applications: fit" {
        /// Most rows that are simulated so that one is at each measured time: between rows a motion is interpolated,
        /// which no polynomial does across an impact.
        most_rows: f64 = 5000.0, moves "parameters that are estimated";
        /// Times are whole multiples of a step up to this share of it.
        rounded_time: f64 = 1e-6, moves "parameters that are estimated";
        /// Starts in the box, in addition to its middle.
        starts: usize = 8, moves "parameters that are estimated";
        /// Most steps from each start on a surrogate.
        steps: usize = 40, moves "parameters that are estimated";
        /// Most steps with simulations that polish an estimate.
        polishing_steps: usize = 4, moves "parameters that are estimated";
        /// Most boxes around the estimate over which surrogates are made.
        boxes: usize = 10, moves "parameters that are estimated";
        /// Share of the noise that the surrogate's error may be before another box is tried.
        rough: f64 = 0.05, moves "parameters that are estimated";
        /// Size of the next box in multiples of the last.
        next_box: f64 = 0.35, moves "parameters that are estimated";
        /// A smaller error than this share of the last one is worth another box.
        better: f64 = 0.7, moves "parameters that are estimated";
        /// An estimate beyond this share of a box may lie outside of it.
        edge: f64 = 0.95, moves "parameters that are estimated";
        /// Half of a difference quotient's step in η: polynomials are smooth.
        step_of_difference: f64 = 1e-4, moves "parameters that are estimated";
        /// A step that is shorter than this share of the estimate's deviation, or of the box, ends the search.
        short_step: f64 = 1e-3, moves "parameters that are estimated";
        /// Smallest eigenvalue of JᵀJ, relative to the largest, below which a direction is not determined.
        singular: f64 = 1e-13, moves "parameters that are estimated";
        /// Most nodes of a polynomial that stands for a surrogate.
        most_nodes: usize = 4096, moves "consistent sets";
        /// Highest degree along an axis of a polynomial that stands for a surrogate.
        most_degree: usize = 14, moves "consistent sets";
        /// Share of the noise by which a polynomial may differ from the surrogate while a set is approached.
        coarse: f64 = 1e-3, moves "consistent sets";
        /// Share of the noise by which a polynomial may differ from the surrogate at the end: many rows leave a small
        /// share of the noise.
        fine: f64 = 1e-5, moves "consistent sets";
        /// A polynomial that differs by less than this share of the error that values have anyway is fine enough, too.
        fine_beside_error: f64 = 0.2, moves "consistent sets";
        /// Points at which a polynomial is compared with the surrogate, by axis.
        points_an_axis: usize = 32, moves "consistent sets";
        /// Most corners at which a polynomial is compared with the surrogate.
        corners: usize = 64, moves "consistent sets";
        /// Rounding of values, as a share of the noise.
        rounding: f64 = 1e-9, moves "consistent sets";
        /// Extent of the box in which least squares begin, in multiples of the consistent set's.
        around: f64 = 4.0, moves "parameters that are estimated";
        /// Cells along either parameter of the raster that shows a consistent set.
        cells: usize = 160, moves "pictures of consistent sets";
        /// Axes that fit the set no better than this share of their volume are the last.
        shrunk: f64 = 0.6, moves "consistent sets";
        /// Most pavings by which a set is approached.
        rounds: usize = 24, moves "consistent sets";
        /// Measured values that are used at first.
        first_values: usize = 40, moves "consistent sets";
        /// Surrogates are made anew where their error is more than this share of the noise.
        rough_surrogate: f64 = 3e-4, moves "consistent sets";
        /// Surrogates are made anew if they have less than this share of the error.
        better_surrogate: f64 = 0.7, moves "consistent sets";
        /// Most runs that make surrogates.
        most_runs: usize = 8, moves "consistent sets";
        /// Times that an order is raised, or steps are halved.
        raised: usize = 3, moves "consistent sets";
        /// Volumes of the last pavings may differ by this share of the outer one before simulations are refined.
        volumes_apart: f64 = 0.03, moves "consistent sets";
        /// Tolerance of the factor of the noise at which rows are explained.
        tolerance_of_factor: f64 = 0.01, moves "rows that no parameters explain";
        /// Boxes that are examined for the factor of the noise at which rows are explained.
        boxes_of_factor: usize = 4000, moves "rows that no parameters explain";
        /// Rows that are as bad as the worst at the best parameters, up to this share.
        as_bad: f64 = 0.05, moves "rows that no parameters explain";
        /// Most rows that are omitted, one at a time, to find rows that nothing explains.
        left_out_rows: usize = 6, moves "rows that no parameters explain";
    }
}
