//! Constants of the room `lsp`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// The language server.
    "lsp" {
        /// Most names of a kind that are proposed.
        most_of_a_kind: usize = 100, moves "names that are proposed";
        /// Deepest nesting of references and choices that is followed.
        depth_of_schema: usize = 12, moves "keys that are proposed";
        /// Most files of a folder that are examined for an `include`.
        most_files: usize = 200, moves "which models a file of assemblies belongs to";
        /// Time without a new reading after which mechanisms are examined.
        quiet: Duration = Duration::from_millis(400), moves "how soon diagnostics are shown";
    }
}
