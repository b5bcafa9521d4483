//! Constants of the room `overview`.

use symdiff::constants::tuning;

tuning! {
    /// Results for people, on the terminal.
    "overview" {
        /// Most names of parts that share a tolerance.
        named_assemblies: usize = 8, moves "the overview of a run";
        /// Share of a band's width that held-out answers of a smooth response do not miss a surrogate by.
        abrupt: f64 = 0.1, moves "warnings of programs that answer abruptly";
        /// Most lines about excitations: they fit a screen.
        excitation_lines: usize = 12, moves "the overview of a run";
        /// Where functions move an output no further than this, constants are enough.
        constants_are_enough: f64 = 1.005, moves "the overview of a run";
        /// Most rows of errors: they fit a screen.
        rows_of_errors: usize = 24, moves "the overview of a run";
        /// Most rows of an analysis: they fit a screen.
        rows_of_analysis: usize = 30, moves "the overview of a run";
        /// Parameters that are named as those which contribute most to an output.
        parameters_that_matter: usize = 3, moves "the overview of a run";
        /// Most singular configurations whose times are told, and most events.
        singular_configurations: usize = 4, moves "the overview of a run";
        /// Most names of constraints, coordinates or outputs in a line.
        names_in_line: usize = 6, moves "the overview of a run";
        /// Most dimensions of an output that are printed.
        stack_rows: usize = 30, moves "the overview of a stack";
        /// Most bounds that are named as unreliable.
        unreliable_bounds: usize = 4, moves "warnings of a run";
        /// Most numbers that are named as unreliable.
        unreliable_numbers: usize = 4, moves "warnings of a run";
    }
}
