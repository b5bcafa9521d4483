//! Requirements on the number of a key: dimension, permitted dependencies, and range.

use super::names::Context;
use super::quantity::Dimension;
use super::unit::Unit;

/// What the number of a key must be.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quantity {
    /// As one writes it; several units are divided by ` or `.
    pub unit: &'static str,
    /// Which of them holds.
    pub choice: usize,
    /// What a formula may depend on.
    pub context: Context,
    /// What must hold at every corner of the parameters.
    pub requirement: Option<Requirement>,
    /// Instead of the unit's, where that depends on other keys.
    pub dimension: Option<Dimension>,
}

impl Quantity {
    /// What its unit measures.
    pub fn dimension(&self) -> Dimension {
        if let Some(dimension) = self.dimension {
            return dimension;
        }
        let units: Vec<&str> = self.unit.split(" or ").collect();
        let unit = units.get(self.choice).or(units.first()).copied().unwrap_or_default();
        // A test parses every unit of every element.
        Unit::parse(unit).map_or(Dimension::NUMBER, |unit| unit.dimension)
    }
}

/// What must hold of a number.
#[derive(Clone, Copy, Debug)]
pub struct Requirement {
    /// Whether it does.
    pub holds: fn(f64) -> bool,
    /// What to say where it does not: `must be positive`.
    pub message: &'static str,
}

impl Requirement {
    /// Above 0.
    pub const POSITIVE: Self = Self { holds: |value| value > 0.0, message: "must be positive" };
    /// 0 or above.
    pub const NONNEGATIVE: Self = Self { holds: |value| value >= 0.0, message: "must not be negative" };
    /// The keyword of the schema that says with 0 what the requirement refuses of negative numbers and 0; `None` where
    /// a negative number may do.
    pub fn limit(&self) -> Option<&'static str> {
        let refused = [-1e9, -1.0, -1e-3, -1e-9].into_iter().all(|value| !(self.holds)(value));
        refused.then(|| if (self.holds)(0.0) { "minimum" } else { "exclusiveMinimum" })
    }

    /// Not 0.
    pub const NONZERO: Self = Self { holds: |value| value != 0.0, message: "must not be zero" };
}
