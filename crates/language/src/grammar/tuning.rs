//! Constants of the room `grammar`.

use std::f64::consts::TAU;

use symdiff::constants::tuning;

tuning! {
    /// Numbers and formulas.
    "grammar" {
        /// Most operations in one formula: its derivatives are longer by a factor.
        formula_terms: usize = 10_000, moves "which formulas are refused";
        /// Angle that is taken for more than one turn, rad; a turn may be written with few digits.
        turn: f64 = 1.001 * TAU, moves "warnings of angles in degrees";
        /// Length above which a bare number is suspicious if others are small, m.
        large_length: f64 = 100.0, moves "warnings of lengths in millimetres";
        /// Length below which a number makes large ones suspicious, m.
        small_length: f64 = 0.1, moves "warnings of lengths in millimetres";
        /// Smallest ratio of two numbers that are near each other.
        near: f64 = 0.5, moves "how ranges are written in messages";
    }
}

const _: () = assert!(TUNING.small_length < TUNING.large_length && TUNING.near <= 1.0);
