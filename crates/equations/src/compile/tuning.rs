//! Constants of the room `compile`.

use symdiff::constants::tuning;

tuning! {
    /// Programs of a step.
    "compile" {
        /// Largest growth factor of freely chosen pivots; above it only pivots that cannot vanish are allowed.
        growth: f64 = 1e4, moves "order of pivots, and so the last digits";
        /// Smallest pivot, relative to its size at the pivot samples: the corrections then still have some six digits,
        /// which is all that Newton's iteration needs of them.
        pivot_loss: f64 = 1e-10, moves "steps with the rank-revealing solve";
        /// Regularisation of a redundant constraint's multiplier, relative to the size of its row: the other
        /// constraints imply this one, so its multiplier stays near the zero from which every step starts it.
        redundant_weight: f64 = 1.0, moves "reactions of redundant constraints";
        /// Largest share of the first version's operations in the iteration at which a second version is worthwhile;
        /// tiles whose lanes need both versions compute both.
        second_version: f64 = 0.8, moves "instructions of models with contacts";
        /// Coordinates that M couples with each, on average, from which on an elimination link by link is examined.
        coupled: usize = 6, moves "instructions of trees";
        /// The same from which on nothing else is examined: the whole matrix takes the third power.
        closely_coupled: usize = 20, moves "instructions of trees";
        /// Share η of the distances in the metric of the start's closures.
        proximity: f64 = 1e-6, moves "starts with open coordinates";
        /// Regularisation ε of a start's constraint, relative to its own size in the matrix's metric.
        regularisation: f64 = 1e-12, moves "last digits of starts";
        /// The same of constraints known to be redundant: the others imply them, and their multipliers stay near zero.
        relaxation: f64 = 1e6, moves "last digits of starts";
        /// Coordinates beyond which fill decides how long a start takes to compile.
        start_coordinates: usize = 100, moves "last digits of starts";
        /// Share of the time between two instants to which an instant is met: times of steps are rounded.
        instant_rounding: f64 = 1e-9, moves "sampled states";
        /// Smallest pivot against the largest entry of its column, at every pivot sample.
        threshold: f64 = 0.1, moves "order of pivots, and so the last digits";
        /// The same of symmetric pivots, which cannot vanish: their order matters more. The corrections lose up to as
        /// many digits, and have more than they need.
        threshold_symmetric: f64 = 1e-3, moves "order of pivots, and so the last digits";
        /// Threshold down to which it is lowered where no pivot passes; below it the matrix is singular.
        singular: f64 = 1e-11, moves "which steps and starts are singular";
        /// The same of a quasi-definite matrix, which is never singular: its pivots may be as small as its
        /// regularisation.
        singular_diagonal: f64 = 1e-15, moves "which starts are singular";
        /// Sparsest columns and rows that are searched for a pivot first.
        searched: usize = 4, moves "order of pivots, and so the last digits";
        /// Factor by which that search widens where it finds no pivot.
        wider: usize = 8, moves "order of pivots, and so the last digits";
        /// Rows beyond which a diagonal order is not searched for in all of them.
        rows_searched: usize = 500, moves "order of pivots, and so the last digits";
        /// Number of states whose numbers guide the choice of pivots.
        pivot_samples: usize = 4, moves "the order of elimination";
    }
}
