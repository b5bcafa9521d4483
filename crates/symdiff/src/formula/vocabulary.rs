//! Vocabulary of formulas in addition to the functions of the language.

use super::SyntaxError;
use super::indices::Index;
use crate::expr::Spline;

/// Tables and units.
#[derive(Clone, Copy, Default)]
pub struct Vocabulary<'v> {
    /// Functions of one argument that are given by their values, with their names.
    pub tables: &'v [(&'v str, Spline)],
    /// Reads the unit behind a number; without it, numbers have no units.
    pub unit: Option<&'v ReadUnit<'v>>,
    /// Other meanings of names; without it, every name stands for itself.
    pub names: Option<&'v dyn Names>,
}

/// Meanings of names in a piece of text that is used several times.
pub trait Names {
    /// The value of an index: in formulas its number, in braces of names its text.
    fn index(&self, name: &str) -> Option<Index>;

    /// An integer that braces and ranges may use, but that is an ordinary name in formulas.
    fn count(&self, name: &str) -> Option<i64>;

    /// The caller's name for it.
    fn full(&self, name: &str) -> String;
}

/// Reads the unit at the beginning of the text behind a number. Locations of errors are relative to that text.
pub type ReadUnit<'v> = dyn Fn(f64, &str) -> Result<Quantity, SyntaxError> + 'v;

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The value in the units in which formulas compute.
    pub value: f64,
    /// Information for the caller, for instance its dimension.
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
