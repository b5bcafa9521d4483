//! Constants of the room `simulate: ensemble`.

use symdiff::constants::tuning;

tuning! {
    /// Samples that are advanced side by side.
    "simulate: ensemble" {
        /// Samples whose rows are closed together.
        extrapolated_width: usize = 32, moves "time only";
        /// Further corrections of a start that is nearest to rest.
        least_squares_corrections: usize = 10, moves "jets of starts that are nearest to rest";
        /// Most steps of a sample within one of the schedule.
        most_lane_steps: usize = 200_000, moves "which samples are given up";
        /// Widest tile in use: a wider one's memory would leave the first-level cache.
        widest_tile: usize = 32, moves "time only";
        /// Most memory of a tile, so that a large mechanism's stays in the second-level cache, bytes. Tiles are
        /// narrower then, down to `narrowest_tile`.
        tile_memory: usize = 2 << 20, moves "time only";
        /// Samples of a tile whose arithmetic takes as long as the dispatch of its instructions does.
        dispatch: usize = 24, moves "time only";
        /// Narrowest tile: below it, dispatch costs more than memory does.
        narrowest_tile: usize = 8, moves "time only";
    }
}
