//! Units in which results are shown.

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use super::quantity::Dimension;
use super::unit::Unit;

/// A unit in which an output is shown; its numbers stay in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayUnit {
    /// As the model writes it: `mm`, `rpm`, `kN*m`.
    pub text: String,
    unit: Unit,
}

impl DisplayUnit {
    /// A unit with its text.
    pub fn new(text: &str, unit: Unit) -> Self {
        Self { text: text.trim().to_owned(), unit }
    }

    /// The unit of a pure number: `1`.
    pub fn number() -> Self {
        Self { text: "1".to_owned(), unit: Unit::ONE }
    }

    /// Dimension.
    pub fn dimension(&self) -> Dimension {
        self.unit.dimension
    }

    /// Value of one of this unit in SI.
    pub fn si(&self) -> f64 {
        self.unit.to_si(1.0)
    }
}

/// The unit in which numbers are shown: the one that the model declares, or SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownUnit<'u> {
    /// As models write it: `N*m`; empty for a number.
    pub text: &'u str,
    /// Value of one of this unit in SI.
    pub si: f64,
}

impl<'u> ShownUnit<'u> {
    /// The declared unit, or the SI unit `unit`.
    pub fn of(declared: &'u Option<DisplayUnit>, unit: &'u str) -> Self {
        declared.as_ref().map_or(Self::from(unit), |declared| Self { text: &declared.text, si: declared.si() })
    }

    /// Converts a value in SI to this unit.
    pub fn of_si(self, value: f64) -> f64 {
        value / self.si
    }
}

impl<'u> From<&'u str> for ShownUnit<'u> {
    /// An SI unit.
    fn from(text: &'u str) -> Self {
        Self { text, si: 1.0 }
    }
}

impl Serialize for DisplayUnit {
    /// `{ "unit": "mm", "si": 0.001 }`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("DisplayUnit", 2)?;
        fields.serialize_field("unit", &self.text)?;
        fields.serialize_field("si", &self.si())?;
        fields.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_in_declared_units() {
        let display = |text: &str| DisplayUnit::new(text, Unit::parse(text).unwrap());
        let unit = display(" mm ");
        assert_eq!((unit.text.as_str(), unit.si()), ("mm", 1e-3));
        let rpm = Some(display("rpm"));
        assert!((ShownUnit::of(&rpm, "rad/s").of_si(std::f64::consts::PI) - 30.0).abs() < 1e-13);
        assert_eq!(serde_json::to_string(&unit).unwrap(), r#"{"unit":"mm","si":0.001}"#);
        let (declared, none) = (Some(unit), None);
        let (shown, si) = (ShownUnit::of(&declared, "m"), ShownUnit::of(&none, "m"));
        assert_eq!((shown.text, shown.of_si(0.15), si.text, si.of_si(0.15)), ("mm", 150.0, "m", 0.15));
    }
}
