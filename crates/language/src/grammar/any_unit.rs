//! Values of any unit, which determine their dimension themselves.

use symdiff::Formula;

use super::formulas::Written;
use super::names::Context;
use super::quantity::Dimension;
use super::reader::Reader;
use super::symbols::SymbolTable;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Reads a formula or a number with its unit, of any dimension, and that dimension if it is known.
    pub fn any_unit(&mut self, node: &Node, context: Context) -> Option<(Formula, Option<Dimension>)> {
        let (formula, dimension) = match self.written(node)? {
            Written::Quantity { value, unit } => (Formula::number(unit.to_si(value)), Some(unit.dimension)),
            Written::Formula(formula) => {
                self.check_names(node, &formula, 0, context).then_some(())?;
                let dimension = self.kind(node, &formula, 0).dimension();
                (formula, dimension)
            }
        };
        self.refuse_like_names(node);
        self.warn_of_fraction(node);
        self.require(node, &formula, |_| true, "");
        Some((formula, dimension))
    }
}
