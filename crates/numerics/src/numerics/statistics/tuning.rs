//! Constants of the room `numerics: statistics`.

use symdiff::constants::tuning;

tuning! {
    /// Distributions and rare shares.
    "numerics: statistics" {
        /// Share of the points that is drawn from the law itself: no weight is more than its reciprocal.
        defensive: f64 = 0.2, moves "shares of failing products";
        /// Step of a difference quotient in normal scores.
        step_of_scores: f64 = 1e-2, moves "shares of failing products";
        /// Most steps of a search for the likeliest point that fails.
        steps_to_likeliest: usize = 25, moves "shares of failing products";
        /// Longest step of a search for the likeliest point that fails, in normal scores.
        longest_step: f64 = 1.5, moves "shares of failing products";
        /// Places nearer to each other than this are one.
        places_apart: f64 = 0.7, moves "shares of failing products";
        /// Random shifts of a lattice of samples: the replicates give sampling errors.
        replicates: usize = 16, moves "statistics, and their sampling errors";
        /// Most samples of a replicate whose quantiles are those of all replicates together.
        pooled: usize = 1 << 12, moves "quantiles of few samples, and their sampling errors";
        /// Largest normal score up to which a law without a closed quantile is tabulated.
        farthest_score: i32 = 9, moves "samples of laws without a closed quantile";
        /// Intervals to a score of the table of a law without a closed quantile.
        per_score: i32 = 64, moves "samples of laws without a closed quantile";
        /// Half a step for slopes at the table's points.
        step_of_table: f64 = 1e-4, moves "samples of laws without a closed quantile";
        /// Points of a replicate of a rare share.
        points: usize = 1 << 13, moves "rare shares of failing products";
        /// Directions of a replicate of directional sampling.
        directions: usize = 1 << 8, moves "rare shares of failing products";
        /// Directions of a replicate toward points that fail.
        toward_failing: usize = 256, moves "rare shares of failing products";
        /// Most places about which samples are drawn, of the first search.
        places: usize = 6, moves "rare shares of failing products";
        /// Most places about which samples are drawn, if more are needed to cover all that fails.
        most_places: usize = 48, moves "rare shares of failing products";
        /// A sampling error of at most this share of the value is small enough.
        close: f64 = 5e-3, moves "rare shares of failing products";
        /// The narrowest of several intervals is too narrow by chance: so much wider is each.
        narrowest_widened: f64 = 1.25, moves "rare shares of failing products";
        /// Subset simulation's chains depend on each other, and its replicates are not normal: so much wider is its
        /// interval.
        dependent_chains: f64 = 1.6, moves "rare shares of failing products";
        /// The mixture does not cover a failing point whose weight exceeds this multiple of the share.
        uncovered: f64 = 30.0, moves "rare shares of failing products";
        /// Rays find where the slack changes its sign to so much of the share.
        along_ray: f64 = 1e-3, moves "rare shares of failing products";
        /// Largest distance of two methods' shares, as a multiple of the sum of their intervals' half widths.
        intervals_apart: f64 = 2.0, moves "rare shares of failing products";
        /// Largest distance at which the likeliest point that fails is searched for, in normal scores.
        farthest_likeliest: f64 = 8.0, moves "rare shares of failing products";
        /// Steps along a ray in which changes of sign are searched for.
        steps_of_ray: usize = 20, moves "rare shares of failing products";
        /// Steps to each change of sign along a ray.
        secants: usize = 5, moves "rare shares of failing products";
        /// Length of a ray beyond √k, the usual length of a point in k dimensions.
        beyond_usual: f64 = 8.0, moves "rare shares of failing products";
        /// Samples of a replicate in each level of subset simulation.
        samples_of_level: usize = 500, moves "rare shares of failing products";
        /// Samples of a level that begin the next one.
        seeds_of_level: usize = 50, moves "rare shares of failing products";
        /// Most levels of subset simulation: less than 1e-16 fails then.
        levels: usize = 17, moves "rare shares of failing products";
        /// Acceptance of a chain that moves best.
        accepted: f64 = 0.44, moves "rare shares of failing products";
        /// Share of new numbers in a chain's first steps.
        first_share: f64 = 0.6, moves "rare shares of failing products";
    }
}
