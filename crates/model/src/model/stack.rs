//! `analysis: dimensions`: formulas of parameters, without a mechanism or time.

use super::black_box::OF_MECHANISMS;
use super::description::{Analysis, Formulation};
use crate::grammar::Symbol;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node};

/// Sections that make a model more than a stack of dimensions.
fn of_others() -> impl Iterator<Item = &'static str> {
    OF_MECHANISMS.into_iter().filter(|key| *key != "analysis").chain(["simulation"])
}

/// A model that has outputs, parameters, and nothing of a mechanism is one of dimensions; one that says so has nothing
/// of a mechanism.
pub(super) fn read(reader: &mut Reader, fields: &Fields) {
    let mut foreign = of_others().filter(|key| fields.get(key).is_some());
    let is_said = reader.model.analysis == Analysis::Dimensions;
    if !is_said {
        let has = |key: &str| fields.get(key).is_some_and(|node| !node.is_null());
        let is_complete = has("outputs") && has("parameters");
        let is_other = ["analysis", "black_box", "include"].iter().any(|key| fields.get(key).is_some());
        let is_misspelt = of_others().any(|key| fields.get(key).is_none() && !fields.lacks(key));
        if !is_complete || is_other || is_misspelt || foreign.next().is_some() {
            return;
        }
        reader.model.analysis = Analysis::Dimensions;
    }
    reader.model.simulation.formulation = Formulation::Absolute;
    for key in foreign {
        let message = format!("dimensions have no mechanism and no time, so `{key}` has no meaning");
        reader.error(
            Code::WrongAnalysis,
            fields.key_span(key),
            message,
            "leave out `analysis: dimensions`, or this".to_owned(),
        );
    }
}

/// Reports outputs of the time, which dimensions do not have.
pub(super) fn refuse_time(reader: &mut Reader, entries: &[Entry]) {
    if reader.model.analysis != Analysis::Dimensions {
        return;
    }
    let formula_of = |entry: &Entry| entry.value.get("formula").unwrap_or(&entry.value).clone();
    let nodes: Vec<Node> = entries.iter().map(formula_of).collect();
    let mut found: Vec<Span> = Vec::new();
    for node in &nodes {
        let Some(scalar) = node.scalar() else { continue };
        let Ok(formula) = symdiff::Formula::parse(&scalar.text) else { continue };
        let names = formula.names().filter(|(name, _)| matches!(reader.symbol(name), Some(Symbol::Time)));
        found.extend(names.map(|(_, span)| scalar.place(&node.span, span)));
    }
    for at in found {
        reader.error(
            Code::WrongAnalysis,
            at,
            "dimensions have no time",
            "with `simulation`, and bodies, outputs are motions".to_owned(),
        );
    }
}
