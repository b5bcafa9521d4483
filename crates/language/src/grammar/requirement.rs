//! Requirements on the number of a key: dimension, permitted dependencies, and range.

use super::names::Context;
use super::quantity::Dimension;
use super::unit::Unit;

/// Requirements on the number of a key.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quantity {
    /// Unit as written; several units are separated by ` or `.
    pub unit: &'static str,
    /// Index of the applicable unit.
    pub choice: usize,
    /// Dependencies that a formula may have.
    pub context: Context,
    /// Requirement at every corner of the parameters.
    pub requirement: Option<Requirement>,
    /// Dimension instead of that of the unit, if it depends on other keys.
    pub dimension: Option<Dimension>,
}

impl Quantity {
    /// Dimension of the number: the given one, else that of the applicable unit.
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

/// Requirement on a number.
#[derive(Clone, Copy, Debug)]
pub struct Requirement {
    /// Whether a number meets it.
    pub holds: fn(f64) -> bool,
    /// Message if a number does not: `must be positive`.
    pub message: &'static str,
}

impl Requirement {
    /// Above 0.
    pub const POSITIVE: Self = Self { holds: |value| value > 0.0, message: "must be positive" };
    /// 0 or above.
    pub const NONNEGATIVE: Self = Self { holds: |value| value >= 0.0, message: "must not be negative" };
    /// Keyword of the schema that, with the limit 0, refuses the negative numbers and 0 that the requirement refuses;
    /// `None` if some negative number meets the requirement.
    pub fn limit(&self) -> Option<&'static str> {
        let refused = [-1e9, -1.0, -1e-3, -1e-9].into_iter().all(|value| !(self.holds)(value));
        refused.then(|| if (self.holds)(0.0) { "minimum" } else { "exclusiveMinimum" })
    }

    /// Not 0.
    pub const NONZERO: Self = Self { holds: |value| value != 0.0, message: "must not be zero" };
}
