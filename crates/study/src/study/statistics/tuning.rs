//! Constants of the room `study: statistics`.

use symdiff::constants::tuning;

tuning! {
    /// Distributions and shares.
    "study: statistics" {
        /// A surrogate reaches as many standard deviations to either side of a normal law: 2e-9 of it lies beyond.
        sigmas_of_surrogate: f64 = 6.0, moves "which box surrogates of statistics have";
        /// Most samples of the surrogate of a reduced output.
        most_samples_of_numbers: usize = 1 << 18, moves "statistics of reduced outputs";
        /// Samples if a model asks for no number: the quantiles of a normal law's three deviations need 2731.
        samples_of_random: usize = 1 << 12, moves "statistics of random excitations";
        /// Most numbers that are stored: samples times rows times outputs.
        most_numbers_of_random: usize = 1 << 26, moves "which statistics are refused";
        /// Most samples under random excitations: those of one seed have streams of their own.
        most_realisations: usize = 1 << 24, moves "which statistics are refused";
        /// Samples that are simulated with halved steps too.
        halved: usize = 16, moves "errors of statistics of random excitations";
        /// Most samples of the surrogates of margins.
        most_samples_of_margins: usize = 1 << 18, moves "shares that fulfil requirements";
        /// If fewer samples than this fail, further samples are drawn near the failures.
        few_failing: usize = 400, moves "shares that fulfil requirements";
        /// If fewer samples than this fail, samples that are drawn at the failing points count if their interval is
        /// narrower.
        many_failing: usize = 4000, moves "shares that fulfil requirements";
        /// Samples from which failing points are searched for.
        starts_of_places: usize = 12, moves "shares that fulfil requirements, and tolerances that are found for a yield";
        /// Requirements whose margins at all samples are in memory at once.
        requirements_at_once: usize = 16, moves "memory of statistics";
        /// Margins that are in memory at once in a search for points that fail.
        most_margins_at_once: usize = 1 << 22, moves "memory of statistics";
        /// Fewest simulations, a power of two.
        fewest_simulations: usize = 1 << 10, moves "errors of surrogates of statistics";
        /// Most simulations, a power of two.
        most_simulations: usize = 1 << 16, moves "errors of surrogates of statistics";
        /// Shares of the products that may differ are determined to this part of the smallest share beyond a requested
        /// quantile.
        fine_share: f64 = 0.25, moves "errors of surrogates of statistics";
        /// Numbers of simulations that may differ by more than ε, of which the best is taken for each quantile. The
        /// limits of the shares of all products have 95 % confidence together.
        beyond_error: [usize; 5] = [0, 4, 16, 64, 128], moves "errors of surrogates of statistics";
        /// Samples if a model asks for no number: about a million.
        samples: usize = 1 << 20, moves "statistics of outputs";
        /// Statistics over time use one in this many of the samples: quantiles are bands there. The row in which an
        /// output varies most has all.
        over_time: usize = 16, moves "statistics of outputs";
        /// Most numbers that all samples hold together.
        most_numbers: usize = 1 << 25, moves "which statistics have fewer samples";
        /// Samples, at most, where each costs a loop closure.
        closed_samples: usize = 1 << 14, moves "statistics of outputs";
        /// Samples of a replicate for a mean and a deviation alone.
        few_samples: usize = 1 << 12, moves "statistics of outputs";
        /// Samples of a replicate for a mean and a deviation alone, if each costs a loop closure.
        few_closed_samples: usize = 1 << 8, moves "statistics of outputs";
        /// Samples at which the polynomial through an output's own samples is compared with the loop closure.
        compared_samples: usize = 256, moves "statistics of outputs";
        /// The polynomial replaces the closure if it differs by no more than the first, as a share of the values'
        /// range, or the second, as a share of the stated error.
        near_closure: (f64, f64) = (1e-4, 0.5), moves "statistics of outputs";
        /// A difference quotient's step, as a share of the interval's half width.
        step_of_difference: f64 = 1e-2, moves "statistics of outputs";
        /// Intervals of a histogram.
        intervals: usize = 60, moves "histograms";
        /// Halvings of the interval of a radius: to the last bit.
        halvings: usize = 52, moves "samples of laws in zones";
    }
}
