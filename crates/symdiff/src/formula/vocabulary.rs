//! What formulas may use beside the functions of the language.

use super::SyntaxError;
use super::indices::Index;
use crate::expr::Spline;

/// Tables and units.
#[derive(Clone, Copy, Default)]
pub struct Vocabulary<'v> {
    /// Functions of one argument that are given by their values, by their names.
    pub tables: &'v [(&'v str, Spline)],
    /// Reads the unit that stands behind a number; without it, numbers have no units.
    pub unit: Option<&'v ReadUnit<'v>>,
    /// Other meanings of names; without it, every name stands for itself.
    pub names: Option<&'v dyn Names>,
}

/// What names stand for in a piece of text that is used several times.
pub trait Names {
    /// The value of an index: in formulas its number, in braces of names its text.
    fn index(&self, name: &str) -> Option<Index>;

    /// A whole number that braces and ranges may use, but that is a name as others are in formulas.
    fn count(&self, name: &str) -> Option<i64>;

    /// The name by which the caller knows it.
    fn full(&self, name: &str) -> String;
}

/// From a number and the text behind it, which begins with the unit. Places of errors are in that text.
pub type ReadUnit<'v> = dyn Fn(f64, &str) -> Result<Quantity, SyntaxError> + 'v;

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The value in the units in which formulas compute.
    pub value: f64,
    /// What the caller is to know of it, for instance its dimension.
    pub mark: u64,
    /// Bytes of the unit's text.
    pub length: usize,
}

impl std::fmt::Debug for Vocabulary<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let tables: Vec<&str> = self.tables.iter().map(|(name, _)| *name).collect();
        formatter.debug_struct("Vocabulary").field("tables", &tables).field("units", &self.unit.is_some()).finish()
    }
}
