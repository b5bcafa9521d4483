//! Constants of the room `simulate: adjoint`.

use symdiff::constants::tuning;

tuning! {
    /// Derivatives backwards in time.
    "simulate: adjoint" {
        /// Ends of cells are the same up to this share.
        same_cells: f64 = 1e-12, moves "gradients by functions of time, within rounding";
        /// Memory for the states of a tile, bytes.
        path_bytes: usize = 32 << 20, moves "memory and time of gradients";
        /// Further corrections of a start that is nearest to rest: least squares converge linearly, though fast.
        open_corrections: usize = 10, moves "gradients of starts that are nearest to rest";
        /// Memories of a tile, in units of that of its steps: values and adjoints.
        tiles_memories: usize = 2, moves "memory of gradients";
    }
}
