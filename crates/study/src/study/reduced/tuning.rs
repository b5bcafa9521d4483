//! Constants of the room `study: reduced`.

use symdiff::constants::tuning;

tuning! {
    /// Bounds of numbers of a motion, and verdicts.
    "study: reduced" {
        /// A corner's course cuts the time instead of the nominal one if its range exceeds this multiple of the
        /// nominal one's.
        much_further: f64 = 4.0, moves "bounds of reduced outputs";
        /// Factor by which the estimate of a dip between rows may be wrong.
        safety_of_dip: f64 = 2.0, moves "verdicts of requirements over time";
        /// Most numbers of reduced outputs that are stored, so that motions are not simulated twice.
        most_kept: usize = 1 << 24, moves "memory of reduced outputs";
        /// Samples evaluated by one thread at once. Fixed, so that results do not depend on the number of threads.
        samples_at_once: usize = 512, moves "time only";
        /// Most windows of a reduced output: a motion with more extremes has them two by two in one.
        most_windows: usize = 8, moves "bounds of reduced outputs";
        /// A dip between two humps cuts the time if it is deeper than this share of the range.
        deep: f64 = 0.02, moves "bounds of reduced outputs";
        /// Most rounds of a study that refines itself, after the first.
        rounds: usize = 5, moves "studies that refine themselves";
        /// Amount by which a degree grows from round to round.
        more_degrees: usize = 2, moves "studies that refine themselves";
        /// Factor by which a tolerance becomes smaller from round to round.
        smaller_tolerance: f64 = 8.0, moves "studies that refine themselves";
        /// Rounding of a sample's margin, as a share of its limit: a sample that meets the limit exactly does not pass
        /// it.
        rounding_of_margin: f64 = 1e-12, moves "verdicts of requirements";
        /// Words of motions, and humps in which an event occurs, at most.
        most_occurring_parts: usize = 6, moves "bounds of instants over a part of the box";
        /// An instant is at the end of a segment, or of the time in which it is searched for, if it is so near, as a
        /// share of the run.
        at_event: f64 = 1e-6, moves "bounds of instants over a part of the box";
        /// A hump grazes within rounding whose height is this share of how far heights range.
        grazed_height: f64 = 1e-6, moves "bounds of instants over a part of the box";
        /// Rounds of the search for a sample that fails, if bounds say that there may be one.
        rounds_of_search: usize = 6, moves "verdicts of requirements";
        /// First distance of the search for a sample that fails, in ξ.
        first_reach: f64 = 0.5, moves "verdicts of requirements";
    }
}
