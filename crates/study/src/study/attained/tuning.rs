//! Constants of the room `study: attained`.

use symdiff::constants::tuning;

tuning! {
    /// Ends that are searched for along gradients.
    "study: attained" {
        /// Fewer parameters are searched by the surrogate alone, whose samples are dense enough.
        fewest_parameters: usize = 6, moves "bounds of models with many parameters";
        /// Most ends that are climbed to from three points; more rows are climbed to from samples of those.
        followed_ends: usize = 128, moves "bounds of models with many parameters";
        /// Most steps of a climb along gradients.
        steps_of_climb: usize = 24, moves "bounds of models with many parameters";
        /// How often ends are climbed to from samples that others found.
        shared_rounds: usize = 3, moves "bounds of models with many parameters";
        /// Corners from which ends are climbed to at which climbs do not agree.
        corners_of_doubt: usize = 12, moves "bounds of models with many parameters";
        /// Simulations that a gradient in the last row costs, for the count; in earlier rows less.
        cost_of_gradient: usize = 4, moves "bounds of models with many parameters";
        /// Work for each simulation of the budget: gradients count in full, and most of them are of shorter motions.
        work_of_budget: usize = 4, moves "bounds of models with many parameters";
        /// Fewest points of polynomials in addition to the middle of the box: two more than the parameters.
        least_points: usize = 16, moves "bounds of models with many parameters";
        /// Most points of polynomials in addition to the middle of the box: two more than the parameters.
        most_points: usize = 32, moves "bounds of models with many parameters";
        /// Points of polynomials that are the surrogate of a run: with this many, the error that 100 parameters of a
        /// chain leave to statistics is a tenth of their spread.
        kept_points: usize = 64, moves "bounds of models with many parameters";
        /// A step that promises less than this share of the output's range in the row is omitted.
        worth_of_step: f64 = 1e-3, moves "bounds of models with many parameters";
        /// A step that promises less than this share of the error that is allowed is omitted.
        worth_of_allowed: f64 = 0.1, moves "bounds of models with many parameters";
        /// Pairs of points whose curvature counts.
        memory_of_curvature: usize = 8, moves "bounds of models with many parameters";
        /// Cosine of the angle between a move and the change of the gradient below which they give no curvature.
        no_curvature: f64 = 1e-6, moves "bounds of models with many parameters";
        /// Share of a matrix's size below which a product with it is rounding.
        rounding_of_product: f64 = 1e-12, moves "bounds of models with many parameters";
        /// Rounds of conjugate gradients for each parameter: on a face of the box they are as many as pairs of points
        /// whose curvature counts, and most faces take one. Most searches end long before; a few need seven.
        rounds_of_face: usize = 16, moves "bounds of models with many parameters";
        /// Least error of an end, as a share of the one that is allowed: some climbs prove nothing.
        least_error: f64 = 0.2, moves "errors of attained ends";
    }
}
