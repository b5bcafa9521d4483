//! Constants of the room `methods: chebyshev: composition`.

use symdiff::constants::tuning;

tuning! {
    /// Outputs that follow from coordinates.
    "methods: chebyshev: composition" {
        /// Most independent coordinates that are moved one by one.
        most_moved: usize = 4, moves "errors of Chebyshev bounds";
        /// A move of an end by less than this share of the range's width moves the place of the extreme by so little
        /// that it does not matter.
        far: f64 = 0.1, moves "errors of Chebyshev bounds";
        /// Values of all outputs that are in memory at once.
        values_at_once: usize = 1 << 20, moves "time and memory";
        /// Fewest points that are taken together.
        least_at_once: usize = 16, moves "time and memory";
        /// Largest mechanism, in coordinates, whose independent coordinates are searched for in every row.
        most_coordinates: usize = 300, moves "Chebyshev bounds";
        /// An output is the polynomial through its samples if both differ by less than this share of its range,
        /// rounding aside.
        alike: f64 = 1e-10, moves "Chebyshev bounds";
        /// Rounding of an output's values, as a share of the largest.
        rounding: f64 = 256.0 * f64::EPSILON, moves "Chebyshev bounds";
        /// An output does not follow from the coordinates if it differs from its simulated samples by the first, as a
        /// share of their range, and the second, as a share of their values: accelerations and reactions of the
        /// samples have errors of the scheme that those which follow do not have.
        disagrees: (f64, f64) = (0.25, 1e-3), moves "Chebyshev bounds";
        /// Samples at which outputs are compared with the simulation, at most.
        compared: usize = 24, moves "Chebyshev bounds";
        /// Samples, for either end of an output, near which it is searched for.
        seeds: usize = 4, moves "Chebyshev bounds";
        /// Distance along some axis by which samples are apart near which an output is searched for, in ξ.
        seeds_apart: f64 = 0.5, moves "Chebyshev bounds";
        /// Corners of the box at which a search looks first: all of eight parameters', and of more such that any two
        /// meet at all their ends.
        corners: usize = 256, moves "Chebyshev bounds";
        /// Rows examined one after the other, so that each can begin where the one before ended. Fixed, so that results
        /// do not depend on the number of threads.
        rows_in_order: usize = 16, moves "Chebyshev bounds";
        /// A coordinate turns where it ends so far from where it began, in its scale: half a turn.
        turned: f64 = std::f64::consts::PI, moves "Chebyshev bounds of mechanisms with cranks";
    }
}
