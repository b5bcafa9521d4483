//! Constants of the room `study: motion`.

use symdiff::constants::tuning;

tuning! {
    /// Motions that a report shows.
    "study: motion" {
        /// Most arrows; a model with more joints and effects has those of the first.
        most_arrows: usize = 40, moves "arrows in reports";
        /// Straight lines between poses are near enough at this share of the model's size.
        near_pose: f64 = 2e-4, moves "motions in reports";
        /// Fewest poses of a motion that is shown.
        fewest_poses: usize = 24, moves "motions in reports";
        /// Most poses of a motion that is shown.
        most_poses: usize = 600, moves "motions in reports";
        /// Approximate number of two-byte numbers in the motions of a report: with base64 and its plots it stays below
        /// 2 MB.
        report_size: usize = 300_000, moves "motions in reports";
        /// Most steps of a search for the configuration that is nearest to a wanted one.
        steps_of_search: usize = 25, moves "poses that are dragged";
        /// Change of a coordinate for a derivative, in its scale: the error of a difference is about that of rounding.
        step_of_difference: f64 = 1e-7, moves "poses that are dragged";
        /// Furthest change of a coordinate in one step, in its scale.
        furthest: f64 = 0.25, moves "poses that are dragged";
        /// Distance of a closure from its prediction, in the scales of the coordinates, from where on it is another
        /// branch.
        other_branch: f64 = 0.3, moves "poses that are dragged";
        /// Damping that is tried in each step, relative to the diagonal of the normal equations.
        dampings: [f64; 5] = [1e-12, 1e-4, 1e-2, 1.0, 100.0], moves "poses that are dragged";
        /// Shares of a step that are tried.
        shares_of_step: [f64; 3] = [1.0, 0.3, 0.05], moves "poses that are dragged";
        /// A search ends if a step improves the sum of squares by less than this share.
        settled: f64 = 1e-10, moves "poses that are dragged";
        /// Numbers that rows and samples may come to in memory; of a longer simulation every second, third … row is
        /// examined.
        most_numbers: usize = 1 << 24, moves "motions in reports";
        /// Error of a step between events, as a share of how far the motion has gone.
        event_error: f64 = 1e-8, moves "motions in reports";
        /// Rows of a motion that is cut at events, about: it turns within a contact, between the rows of the outputs.
        rows_between_events: usize = 2048, moves "motions in reports";
        /// Rows that are simulated at a time.
        rows_at_once: usize = 64, moves "time only";
        /// Controlling samples of the steps, in addition to the nominal one.
        controlling: usize = 8, moves "motions in reports";
        /// Corners of the box among the samples that are shown.
        corners: usize = 8, moves "motions in reports";
        /// Samples inside the box among those that are shown.
        inside: usize = 8, moves "motions in reports";
        /// Degrees of polynomials by the number of parameters: the sum of degrees in a term is at most this.
        degrees: [usize; 7] = [0, 6, 4, 3, 2, 2, 2], moves "motions in reports";
        /// Most parameters for which polynomials are made; beyond those of `degrees`, of each parameter alone.
        most_parameters: usize = 20, moves "motions in reports";
        /// Most motions under worst functions.
        worst_motions: usize = 8, moves "motions in reports";
    }
}
