//! Constants of the room `study: bounding`.

use symdiff::constants::tuning;

tuning! {
    /// Bands of outputs.
    "study: bounding" {
        /// Estimates of the time steps' error by which the nominal simulation may be outside of a proven motion.
        outside_of_proof: f64 = 3.0, moves "which proven motions are contradicted";
    }
}
