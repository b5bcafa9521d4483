//! Constants of the room `simulate: drive`.

use symdiff::constants::tuning;

tuning! {
    /// Samples that are advanced side by side.
    "simulate: drive" {
        /// Samples whose rows are closed together.
        extrapolated_width: usize = 32, moves "time only";
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
