//! Constants of the room `numerics: search`.

use symdiff::constants::tuning;

tuning! {
    /// Searches for extremes of many parameters.
    "numerics: search" {
        /// First distance of the probes, in ξ.
        reach: f64 = 0.25, moves "ranges of functions of many parameters";
        /// Distance of the probes on a face: a maximum nearer to the face than half of it is not seen.
        on_face: f64 = 0.05, moves "ranges of functions of many parameters";
        /// Least distance of probes: nearer, rounding bends parabolas.
        nearest: f64 = 0.01, moves "ranges of functions of many parameters";
        /// Shares of the way to the targets that are tried, ascending.
        strides: [f64; 3] = [0.1, 0.35, 1.0], moves "ranges of functions of many parameters";
        /// Climbs to one extreme from different starts, without and with those of a neighbour.
        starts: (usize, usize) = (24, 2), moves "ranges of functions of many parameters";
        /// Distance along some axis by which starts of climbs are apart, in ξ.
        starts_apart: f64 = 0.5, moves "ranges of functions of many parameters";
        /// With a neighbour's extremes, other starts are tried that are within this share of the range of the best.
        promising: f64 = 0.05, moves "ranges of functions of many parameters";
        /// Local extremes, in addition to the best, from which a neighbour starts.
        others: usize = 4, moves "ranges of functions of many parameters";
        /// Points of the low-discrepancy sequence for each parameter, without and with a neighbour's extremes.
        scattered: (usize, usize) = (32, 2), moves "ranges of functions of many parameters";
        /// Most rounds of a climb to an extreme.
        rounds: usize = 12, moves "ranges of functions of many parameters";
        /// A climb ends where a round neither promises nor brings this share of the range.
        tolerance: f64 = 2e-4, moves "ranges of functions of many parameters";
    }
}
