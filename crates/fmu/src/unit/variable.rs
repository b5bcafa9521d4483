//! Variables of a unit, and units of their numbers.

use serde::{Deserialize, Serialize};

/// Type of a variable that is one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum NumberType {
    /// `Real`, `Float64`.
    Float64,
    /// `Float32`.
    Float32,
    /// `Integer` and `Enumeration` of FMI 2.0, `Int32`.
    Int32,
    /// `Int8`.
    Int8,
    /// `UInt8`.
    UInt8,
    /// `Int16`.
    Int16,
    /// `UInt16`.
    UInt16,
    /// `UInt32`.
    UInt32,
    /// `Int64`, `Enumeration` of FMI 3.0.
    Int64,
    /// `UInt64`.
    UInt64,
    /// `Boolean`: 0 or 1.
    Boolean,
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Its number.
    pub reference: u32,
    /// Its type; the word of the description if it is not a single number of a type known here.
    pub kind: Result<NumberType, String>,
    /// `parameter`, `input`, `output`, `local`, …
    pub causality: String,
    /// Value at the start, if it may be set before.
    pub start: Option<f64>,
    /// Whether its start value can be set.
    pub is_settable: bool,
    /// Its unit, by name.
    pub unit: Option<String>,
}

/// A unit in SI: `kg^a m^b … `, with `SI = factor · value + offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseUnit {
    /// Exponents of kg, m, s, A, K, mol, cd and rad.
    pub exponents: [i32; 8],
    /// Value of the unit in SI.
    pub factor: f64,
    /// Value in SI of a zero in the unit.
    pub offset: f64,
}

/// Base units in the order of [`BaseUnit::exponents`], by the names of their attributes.
pub(super) const BASES: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

impl BaseUnit {
    /// Its SI unit as a product: `kg*m^2*s^-2`; `1` for a number.
    pub fn text(&self) -> String {
        let powers = BASES.iter().zip(self.exponents).filter(|(_, exponent)| *exponent != 0);
        let powers: Vec<String> = powers
            .map(|(base, exponent)| if exponent == 1 { (*base).to_owned() } else { format!("{base}^{exponent}") })
            .collect();
        if powers.is_empty() { "1".to_owned() } else { powers.join("*") }
    }
}
