//! Constants of the room `applications: allocate`.

use symdiff::constants::tuning;

tuning! {
    /// Tolerances that a study chooses.
    "applications: allocate" {
        /// Rounds of linearisation: of worst cases, and of samples, which give less information.
        rounds_of_choice: [usize; 2] = [40, 12], moves "tolerances that are found";
        /// Factor by which a multiple may change in the first round; later rounds allow less.
        first_change: f64 = 2.0, moves "tolerances that are found";
        /// Change of the multiples at which rounds have settled: of worst cases, and of samples.
        settled_choice: [f64; 2] = [1e-6, 3e-3], moves "tolerances that are found";
        /// Most steps towards the largest factor that is good.
        secants: usize = 40, moves "tolerances that are found";
        /// Margin at which the steps towards the largest good factor end, and the width of the factor's bracket,
        /// relative to its upper end.
        close: f64 = 1e-7, moves "tolerances that are found";
        /// The remaining margin may be negative by rounding.
        rounding: f64 = 1e-9, moves "tolerances that are found";
        /// Combinations of grades that are tried.
        combinations: usize = 4000, moves "tolerances that are found";
        /// No tolerance becomes tighter than this share of the model's.
        tightest: f64 = 0.01, moves "tolerances that are found";
        /// Digits of a tolerance that was found.
        digits: i32 = 4, moves "tolerances that are found";
        /// Most studies that confirm tolerances.
        confirming_rounds: usize = 4, moves "tolerances that are found";
        /// Share of a nominal margin that a study may leave unused before another round searches for more.
        unused: f64 = 5e-3, moves "tolerances that are found";
        /// Most studies that confirm a yield.
        rounds_of_share: usize = 6, moves "tolerances that are found";
        /// Share of all tolerances for which more rounds of a yield are worth it.
        unused_of_share: f64 = 5e-4, moves "tolerances that are found";
        /// Share of the products that may fail which is aimed at: its estimate from samples differs a little from study
        /// to study.
        aim: f64 = 0.997, moves "tolerances that are found";
        /// Shares of the nominal margins for which the cost is reported.
        traded: usize = 6, moves "the list of costs beside margins";
        /// Points of each replicate. The confirming study finds the rest.
        points: usize = 1 << 9, moves "tolerances that are found for a yield";
        /// If less than this share may fail, points are drawn about the points that fail first.
        rare: f64 = 0.1, moves "tolerances that are found for a yield";
        /// Most failing points about which points are drawn for a requirement.
        places: usize = 6, moves "tolerances that are found for a yield";
        /// Points are drawn again if a multiple changes by this factor.
        redrawn: f64 = 1.2, moves "tolerances that are found for a yield";
        /// Samples from which the derivatives of the quantile are taken: those between these multiples of the share
        /// that may fail.
        beside_quantile: [f64; 2] = [0.4, 2.5], moves "tolerances and nominal values that are found for a yield";
        /// Fewest samples from which the derivatives of the quantile are taken.
        fewest_beside: usize = 64, moves "tolerances and nominal values that are found for a yield";
        /// A margin that is unknown is taken for one that is this far from being fulfilled: an event that does not
        /// occur fails.
        unknown_margin: f64 = -10.0, moves "tolerances and nominal values that are found, if an event may not occur";
        /// Times that the widest box is made smaller, at most, if its surrogate is not known.
        narrower_boxes: usize = 4, moves "which surrogate tolerances are found by";
        /// The surrogate's order is raised while its margins are off by more than this share of the nominal ones.
        rough: f64 = 0.02, moves "which surrogate tolerances are found by";
        /// Times that the surrogate's order is raised for its margins, at most.
        raised_orders: usize = 3, moves "which surrogate tolerances are found by";
        /// A difference quotient's step, as a share of a multiple.
        step_of_difference: f64 = 1e-3, moves "tolerances that are found";
        /// Worst cases whose points are nearer than this are one, in ξ.
        same_place: f64 = 0.05, moves "tolerances that are found";
    }
}
