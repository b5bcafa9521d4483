//! Constants of the room `numerics: functions_of_time`.

use symdiff::constants::tuning;

tuning! {
    /// Functions of time within limits.
    "numerics: functions_of_time" {
        /// Frequencies that are tried in the width of a peak, one over the time.
        tried_frequencies: f64 = 4.0, moves "ends over functions of a band of frequencies";
        /// Divisions of the distance of two tried frequencies around the best.
        divisions: usize = 40, moves "ends over functions of a band of frequencies";
        /// Share of a cell's part that is added where a kernel ends: a sixth of 3/8, and as much again.
        smeared: f64 = 0.15, moves "ends over functions with a budget";
        /// Ends of cells are the same up to this share of a period.
        same_cell: f64 = 1e-9, moves "ends over functions that may jump";
        /// Share of a cell by which the zero of a kernel may be off, which is straight between the cells' middles.
        zero_off: f64 = 0.05, moves "errors of ends over functions of time";
    }
}
