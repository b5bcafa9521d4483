//! Values of formulas at the corners of the parameters' intervals, and requirements on them.

use symdiff::Formula;

use super::formulas::evaluate;
use super::reader::Reader;
use super::symbols::{Symbol, SymbolTable};
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Checks a formula of parameters at all their corners; a formula with other names is not checked.
    pub fn require(&mut self, node: &Node, formula: &Formula, holds: impl Fn(f64) -> bool, requirement: &str) {
        let varies = self.is_uncertain(formula);
        // At corners with nominal values of all its parameters, the formula has its nominal value.
        let used = formula.names().filter_map(|(name, _)| self.corners_of.get(self.parameter(name)?));
        let mut corners: Vec<usize> = used.flatten().copied().filter(|_| varies).collect();
        corners.sort_unstable();
        corners.dedup();
        for corner in (0..self.corners.len().min(1)).chain(corners) {
            let Some(value) = self.evaluate(formula, corner) else { return };
            if self.broken && !value.is_finite() {
                return;
            }
            let problem = if !value.is_finite() {
                // Reported by the check that every formula is finite.
                if !requirement.is_empty() {
                    return;
                }
                "is not a finite number"
            } else if !holds(value) {
                requirement
            } else {
                continue;
            };
            let text = node.scalar().map_or("", |scalar| scalar.text.as_str());
            let label = &self.corners[corner].label;
            let message = if formula.as_number().is_some() || !value.is_finite() {
                format!("`{}` {problem}{label}", clip(text))
            } else {
                format!("`{}` {problem}, but is {value}{label}", clip(text))
            };
            self.error(Code::OutOfRange, node.span.clone(), message, None);
            return;
        }
    }

    fn parameter(&self, name: &str) -> Option<usize> {
        match self.symbol(name) {
            Some(Symbol::Parameter(index)) => Some(index),
            _ => None,
        }
    }

    /// The formula's value at a corner; `None` if it depends on more than parameters.
    pub fn evaluate(&self, formula: &Formula, corner: usize) -> Option<f64> {
        let corner = self.corners.get(corner)?;
        evaluate(formula, |name| corner.values.get(self.parameter(name)?).copied())
    }

    /// Whether a name of the formula is an uncertain parameter.
    pub fn is_uncertain(&self, formula: &Formula) -> bool {
        let varies = |index: usize| self.varies.get(index).copied().unwrap_or(false);
        formula.names().any(|(name, _)| self.parameter(name).is_some_and(varies))
    }
}
