//! Constants of the room `overview`.

use symdiff::constants::tuning;

tuning! {
    /// Results for people, on the terminal.
    "overview" {
        /// Most names of parts with a shared tolerance.
        named_assemblies: usize = 8, moves "the overview of a run";
        /// Error of a surrogate, as a share of the band's width, above which a program answers abruptly.
        abrupt: f64 = 0.1, moves "warnings of programs that answer abruptly";
        /// Most lines about excitations: they fit a screen.
        excitation_lines: usize = 12, moves "the overview of a run";
        /// Ratio of the ranges under functions and constants up to which constants are enough.
        constants_are_enough: f64 = 1.005, moves "the overview of a run";
        /// Most rows of errors: they fit a screen.
        rows_of_errors: usize = 24, moves "the overview of a run";
        /// Most rows of an analysis: they fit a screen.
        rows_of_analysis: usize = 30, moves "the overview of a run";
        /// Parameters named as those that contribute most to an output.
        parameters_that_matter: usize = 3, moves "the overview of a run";
        /// Most singular configurations whose times are given, and most events.
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
