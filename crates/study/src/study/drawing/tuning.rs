//! Constants of the room `study: drawing`.

use symdiff::constants::tuning;

tuning! {
    /// Drawings of mechanisms.
    "study: drawing" {
        /// Most points of a body between which lengths are sought: pairs of more points are too many to be read in a
        /// drawing.
        most_points: usize = 12, moves "lengths in drawings";
        /// A distance is a parameter if it equals it to this share of its width at both its ends.
        same_length: f64 = 1e-6, moves "lengths in drawings";
    }
}
