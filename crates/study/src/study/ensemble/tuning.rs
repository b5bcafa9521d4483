//! Constants of the room `study: ensemble`.

use symdiff::constants::tuning;

tuning! {
    /// Simulations in blocks.
    "study: ensemble" {
        /// Most values of motions that are in memory at once.
        most_values: usize = 1 << 26, moves "memory of motions that are cut at events";
        /// Times for each step at which a motion is dense.
        times_a_step: usize = 8, moves "outputs between rows";
        /// Times that are observed at once.
        times_at_once: usize = 64, moves "time only";
        /// Rows of a block of jets.
        rows_of_jets: usize = 64, moves "memory of jets";
        /// Values (rows × lines × samples) that one block holds.
        block_values: usize = 1 << 20, moves "memory of runs";
        /// Most rows of a block of samples.
        most_rows: usize = 64, moves "memory of runs";
        /// A range that is narrower than this, relative to the model's size and the run's duration, is rounding:
        /// Newton's iteration ends at 1e-12 or so.
        at_rest: f64 = 1e-10, moves "which outputs count as constant";
        /// Width below which the range of a number of unknown size is rounding.
        number_at_rest: f64 = 1e-12, moves "which reduced outputs count as constant";
        /// Bytes that the values of a part come to, about.
        part_bytes: usize = 64 << 20, moves "files of stored simulations";
        /// Fewest samples of a part; parts are a whole number of these, the widest tile.
        fewest_of_part: usize = 32, moves "files of stored simulations";
        /// Most samples of a part.
        most_of_part: usize = 1024, moves "files of stored simulations";
        /// Numbers that a part of a scan has for each row and output.
        numbers_of_scan: usize = 5, moves "files of stored simulations";
        /// Samples that are visited at once.
        visited_at_once: usize = 256, moves "memory of analyses without time steps";
    }
}
