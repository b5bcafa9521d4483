//! Constants of the room `study: program`.

use symdiff::constants::tuning;

tuning! {
    /// Answers of programs as outputs.
    "study: program" {
        /// Validation samples that are asked twice, at most, besides the nominal one.
        asked_twice: usize = 4, moves "which programs count as noisy";
        /// Differences below this share of the largest value are rounding.
        rounding: f64 = 1e-12, moves "which programs count as noisy";
        /// Most values that are stored for evaluated points: a validation sample is requested under several schedules.
        most_kept: usize = 1 << 22, moves "time only";
        /// Steps of model exchange between two rows, if the model does not say their length.
        steps_a_row: f64 = 10.0, moves "bounds of units of model exchange";
    }
}
