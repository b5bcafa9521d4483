//! Constants of the room `simulate: ensemble`.

use symdiff::constants::tuning;

tuning! {
    /// Samples under the scheme.
    "simulate: ensemble" {
        /// Further corrections of a start that is nearest to rest.
        least_squares_corrections: usize = 10, moves "jets of starts that are nearest to rest";
        /// Most steps of a sample within one of the schedule.
        most_lane_steps: usize = 200_000, moves "which samples are given up";
    }
}
