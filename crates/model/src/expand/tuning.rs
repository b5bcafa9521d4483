//! Constants of the room `expand`.

use symdiff::constants::tuning;

tuning! {
    /// Trees that are written out.
    "expand" {
        /// Most nodes of the tree that is written out: more copies must be a slip.
        nodes: usize = 1_000_000, moves "which models are refused";
        /// Most copies that one `repeat` makes.
        copies: usize = 10_000, moves "which models are refused";
        /// Most instances within one another.
        depth: usize = 20, moves "which models are refused";
        /// Most files that a model includes.
        files: usize = 1000, moves "which models are refused";
        /// Most scenes: each is read, compiled and run.
        scenes: usize = 200, moves "which models are refused";
    }
}
