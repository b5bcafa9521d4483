//! Meanings of names in a copy of a piece of the file, for the parser of formulas.

use symdiff::formula::Names;
use symdiff::formula::indices::Index;

use super::names;
use super::quantity::Dimension;
use crate::syntax::scope::Scope;
use crate::syntax::yaml::Scalar;

/// The names of a scalar in a copy of a piece of the file.
pub(super) struct OwnNames<'s> {
    pub(super) scope: &'s Scope,
    /// Own variable of the formula.
    variable: Option<&'static str>,
}

impl<'s> OwnNames<'s> {
    pub(super) fn of(scalar: &'s Scalar, variable: Option<(&'static str, Dimension)>) -> Option<Self> {
        let scope = scalar.scope.as_deref()?;
        Some(Self { scope, variable: variable.map(|(name, _)| name) })
    }
}

impl Names for OwnNames<'_> {
    fn index(&self, name: &str) -> Option<Index> {
        self.scope.index(name)
    }

    fn count(&self, name: &str) -> Option<i64> {
        self.scope.count(name)
    }

    fn full(&self, name: &str) -> String {
        let is_own = names::is_reserved(name) || self.variable == Some(name);
        if is_own { name.to_owned() } else { self.scope.full(name) }
    }
}

/// A word of a unit that is also a name of the model.
#[derive(Clone, Debug)]
pub struct LikeName {
    pub(super) word: String,
    /// The value with spaces, so that the word is the model's.
    pub(super) spaced: String,
    /// The value with a number before the word, so that it is the unit.
    pub(super) as_unit: String,
    pub(super) dimension: Dimension,
    /// Dimension of the whole unit.
    pub(super) whole: Dimension,
}

impl LikeName {
    pub(super) fn help(&self) -> String {
        format!("`{}` is read as a unit here; write `{}` with spaces for the model's own", self.word, self.spaced)
    }
}
