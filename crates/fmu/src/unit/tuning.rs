//! Constants of the room `fmu: unit`.

use symdiff::constants::tuning;

tuning! {
    /// Files of units of FMI.
    "fmu: unit" {
        /// Most bytes of an entry: an archive may expand a few bytes to very many.
        entry_bytes: u64 = 1 << 31, moves "which units are refused";
        /// Most bytes of a description.
        description_bytes: u64 = 1 << 28, moves "which units are refused";
    }
}
