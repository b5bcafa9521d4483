//! Facts about effects and states before they are in the model.

use symdiff::Formula;
use symdiff::formula::{Names, Vocabulary};

use super::dimension::{self, KnownDimension};
use super::names::NameError;
use super::own_names::OwnNames;
use super::quantity::Dimension;
use super::reader::Reader;
use super::symbols::{Sensor, Symbol, SymbolTable};
use super::unit::{Unit, number_and_unit};
use super::unknown;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Measure of an effect or a state that is not in the model; `None` if the name is of something else.
    pub(super) fn unread_measure(&self, name: &str) -> Option<Result<Symbol, NameError>> {
        if let Some(found) = self.declared.measure(name, Sensor::VALUE.name()) {
            return found.map(|(index, measure)| Ok(self.unread_sensor(self.unread.len() + index, measure)));
        }
        let (owner, member) = name.rsplit_once('.')?;
        if self.model.body(owner).is_some() || self.model.joint(owner).is_some() {
            return None;
        }
        if let Some(Some((index, measure))) = self.declared.measure(owner, member) {
            return Some(Ok(self.unread_sensor(self.unread.len() + index, measure)));
        }
        let unread = self.unread.iter().position(|(known, _)| known == owner)?;
        let measures = &self.unread[unread].1;
        let found = measures.iter().find(|(measure, _)| measure.name() == member);
        Some(match found {
            Some(&(measure, _)) => Ok(self.unread_sensor(unread, measure)),
            None => Err(unknown::no_measure(owner, member, measures)),
        })
    }

    /// Whether a name may belong to a joint that had errors.
    pub(super) fn is_of_unread_joint(&self, name: &str) -> bool {
        name.split_once('.').is_some_and(|(owner, _)| self.unread_joints.iter().any(|unread| unread == owner))
    }

    /// Whether a name is that of an output that had errors.
    pub fn is_unread_output(&self, name: &str) -> bool {
        self.unread_outputs.iter().any(|unread| unread == name)
    }

    fn unread_sensor(&self, index: usize, measure: Sensor) -> Symbol {
        Symbol::Sensor { effect: self.model.effects() + index, measure }
    }

    /// The dimension of a field's value, as far as names are known; nothing is reported.
    pub fn quietly(&mut self, node: &Node) -> Option<Dimension> {
        let scalar = node.scalar()?;
        let own_names = OwnNames::of(scalar, self.variable);
        if let Some((_, unit, _)) = number_and_unit(&scalar.text)
            && let Ok((found, length)) = Unit::leading(unit, |name| self.is_name(name, own_names.as_ref()))
            && length == unit.len()
        {
            return Some(found.dimension);
        }
        let tables: Vec<_> = self.tables.iter().map(|table| (table.name.as_str(), table.spline)).collect();
        let unit = |value: f64, text: &str| Unit::behind(value, text, |name| self.is_name(name, own_names.as_ref()));
        let names = own_names.as_ref().map(|names| names as &dyn Names);
        let formula =
            Formula::parse_with(&scalar.text, &Vocabulary { tables: &tables, unit: Some(&unit), names }).ok()?;
        let name = |name: &str| self.symbol(name).map_or(KnownDimension::Any, |symbol| self.kind_of(symbol));
        dimension::analyse(&formula, name, |spline| self.table(spline), &mut Vec::new()).dimension()
    }
}
