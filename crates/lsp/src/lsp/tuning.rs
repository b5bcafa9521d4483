//! Constants of the room `lsp`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// The language server.
    "lsp" {
        /// Names of a kind that are proposed.
        most_of_a_kind: usize = 100, moves "names that are proposed";
        /// References and choices that are followed one into the other.
        depth_of_schema: usize = 12, moves "keys that are proposed";
        /// Files of a folder that are examined for an `include`.
        most_files: usize = 200, moves "which models a file of assemblies belongs to";
        /// Time that an editor has been quiet when mechanisms are examined.
        quiet: Duration = Duration::from_millis(400), moves "how soon diagnostics are shown";
    }
}
