//! Constants of the room `study: results`.

use symdiff::constants::tuning;

tuning! {
    /// Results, and verdicts that they hold.
    "study: results" {
        /// Most parameters for which the set is paved.
        most_parameters: usize = 6, moves "which fits have a consistent set";
        /// How much higher than both ends of an interval a curve may be, relative to the largest second difference
        /// around it: twice the value of a parabola.
        between_rows: f64 = 0.25, moves "the largest and smallest value of a band over the run";
        /// Share of a power, or of a derivative, that is rounding.
        rounding: f64 = 1e-9, moves "verdicts of verifications";
        /// Share of theory's order that an observed one may be lower.
        below_theory: f64 = 0.05, moves "verdicts of verifications";
        /// Observed orders that exceed theory's by more than this share are not those of short steps yet.
        above_theory: f64 = 0.1, moves "verdicts of verifications";
        /// Methods of a higher order show it only where forces have as many derivatives, and steps are short long
        /// before errors are those of rounding; errors that get there at a higher order than this are as in theory,
        /// too.
        high_order: f64 = 4.0, moves "verdicts of verifications";
        /// Orders that exceed that of theory by more than this factor show only that they do.
        far_above_theory: f64 = 1.5, moves "verdicts of verifications";
        /// An error that falls by less than this order, and is small, is rounding's.
        flat_order: f64 = 1.0, moves "verdicts of verifications";
        /// Largest error that may be rounding's because it hardly falls.
        small_error: f64 = 1e-6, moves "verdicts of verifications";
        /// Errors below this multiple of that of rounding are affected by it.
        touched: f64 = 3.0, moves "verdicts of verifications";
    }
}
