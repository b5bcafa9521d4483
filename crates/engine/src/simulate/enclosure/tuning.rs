//! Constants of the room `simulate: enclosure`.

use symdiff::constants::tuning;

tuning! {
    /// Enclosures of discrete motions.
    "simulate: enclosure" {
        /// Independent coordinates are chosen anew when another moves this many times as much.
        outrun: f64 = 2.0, moves "widths of proven bounds";
        /// Largest entry that V leaves above the diagonal.
        off_diagonal: f64 = 0.05, moves "widths of proven bounds";
        /// Time that relates the motion's velocities to positions, s: only the shape of the remainder depends on it.
        motion_time: f64 = 0.1, moves "widths of proven bounds";
        /// Most corrections of X; the residual that is left is bounded in any case.
        max_corrections: usize = 4, moves "widths of proven bounds";
        /// A correction below this (of a position, in its unit) is rounding.
        settled_correction: f64 = 1e-15, moves "widths of proven bounds";
    }
}
