//! Constants of the room `study: gradient`.

use symdiff::constants::tuning;

tuning! {
    /// Derivatives of outputs over time.
    "study: gradient" {
        /// Halvings of an interval that contains a zero, and golden sections of one that contains an extreme.
        halvings: usize = 60, moves "instants of extremes, within rounding";
        /// Simulations that a gradient of one output in one row costs in lanes. Forwards, the derivatives by one
        /// parameter of all outputs in all rows cost about one.
        backwards: f64 = 0.5, moves "how gradients are computed";
        /// Gradients with two kinds of steps agree to this share of the largest influence.
        agreement: f64 = 0.01, moves "warnings of gradients";
    }
}
