//! Constants of the room `numerics: paving`.

use symdiff::constants::tuning;

tuning! {
    /// Pavings of consistent sets.
    "numerics: paving" {
        /// Slopes below this share of the largest count as errors of the plane.
        flat: f64 = 0.02, moves "consistent sets";
    }
}
