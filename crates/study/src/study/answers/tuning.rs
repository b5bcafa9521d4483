//! Constants of the room `study: answers`.

use symdiff::constants::tuning;

tuning! {
    /// Bounds and summaries from the results of the methods.
    "study: answers" {
        /// A mode is reported that moves an output by more than this share of its range.
        worth_telling: f64 = 1e-3, moves "which modes are reported";
        /// A step resolves a mode that turns by this angle, rad, in it.
        resolving_angle: f64 = 0.1, moves "which modes are reported";
        /// Duration of a jump, as a share of the run's.
        jump_time: f64 = 1e-9, moves "worst functions of excitations as they are written";
        /// Points that lie this close to a straight line are on it, as a share of how far the function ranges.
        straight: f64 = 1e-9, moves "worst functions of excitations as they are written";
        /// Samples evaluated by one thread at once. Fixed, so that results do not depend on the number of threads.
        samples_at_once: usize = 1024, moves "time only";
    }
}
