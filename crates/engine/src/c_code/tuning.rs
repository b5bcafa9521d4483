//! Constants of the room `c_code`.

use symdiff::constants::tuning;

tuning! {
    /// Compiled mechanisms as C.
    "c_code" {
        /// Most equations of a step whose singular configurations have a solve of their own: its matrices are on the
        /// stack.
        most_singular: usize = 64, moves "which models are exported with a solve of singular positions";
        /// Most coordinates and multipliers of a mechanism whose equilibrium is found anew, by dense equations.
        most_balanced: usize = 200, moves "which models are exported with their equilibrium";
    }
}
