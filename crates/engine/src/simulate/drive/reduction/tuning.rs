//! Constants of the room `simulate: drive: reduction`.

use symdiff::constants::tuning;

tuning! {
    /// Numbers that a motion is reduced to.
    "simulate: drive: reduction" {
        /// Points of a path that are evaluated between two steps.
        places_of_path: usize = 4, moves "reduced outputs of paths";
        /// Bisections of a crossing: to the last bit of a share.
        bisections_of_crossing: usize = 52, moves "reduced outputs";
        /// Largest rise of a peak above the piece's ends, as a multiple of that of parabolas through three of the four
        /// values.
        rise_of_peak: f64 = 1.5, moves "reduced outputs";
        /// Points before they are reduced to their convex hull, at least.
        fewest_hull_points: usize = 64, moves "time of zones";
        /// Rounding of a point, relative to the path's greatest coordinate.
        rounding_of_zone: f64 = 8.0 * f64::EPSILON, moves "zones, within rounding";
    }
}
