//! Constants of the room `syntax`.

use symdiff::constants::tuning;

tuning! {
    /// Text, trees and diagnostics.
    "syntax" {
        /// Largest text file that is read, bytes.
        file_bytes: u64 = 10_000_000, moves "which files are refused";
        /// Largest file of a mesh that is read, bytes.
        mesh_bytes: u64 = 100_000_000, moves "which meshes are refused";
        /// Deepest nesting of mappings and sequences; the grammar needs six.
        yaml_depth: usize = 40, moves "which files are refused";
        /// Most scalars, beginnings and ends of collections in a file, which bounds memory.
        yaml_events: usize = 1_000_000, moves "which files are refused";
        /// Most known names that are compared with an unknown one: a model may have many thousands.
        names_known: usize = 1000, moves "suggestions in messages";
        /// Most names that are compared: the known ones, and some more.
        names_compared: usize = 1100, moves "suggestions in messages";
        /// Most known names that are listed in full.
        names_listed: usize = 32, moves "the help of messages";
        /// Names that are listed if there are more.
        names_of_many: usize = 3, moves "the help of messages";
        /// Longest name that is compared or quoted in full, characters.
        name_length: usize = 60, moves "suggestions and quotes in messages";
        /// Most diagnostics that are shown; the others are counted.
        diagnostics_shown: usize = 50, moves "how many messages are shown";
        /// Fewest occurrences of a message that is shown once, with the lines of the others.
        occurrences: usize = 3, moves "how repeated messages are shown";
        /// Most lines of repeated messages that are named.
        lines_named: usize = 8, moves "how repeated messages are shown";
        /// Most lines between two labels that are shown in one piece.
        lines_together: usize = 6, moves "excerpts in messages";
        /// Most characters of a line on either side of a label that are shown.
        line_length: usize = 400, moves "excerpts in messages";
        /// Most characters of a line of help.
        help_length: usize = 100, moves "how help is wrapped";
    }
}

const _: () = assert!(TUNING.names_compared >= TUNING.names_known && TUNING.names_of_many < TUNING.names_listed);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_have_reasons() {
        let constants = Tuning::constants();
        let bytes = constants.iter().find(|constant| constant.name == "file_bytes").unwrap();
        assert_eq!((bytes.room, bytes.value), ("syntax", "10_000_000"));
        assert_eq!(bytes.why, "Largest text file that is read, bytes.");
    }
}
