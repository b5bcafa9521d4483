//! Units in which outputs are shown: `stroke: { formula: slider.x, unit: mm }`.

use super::parameters;
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Node, Value};

/// The key of the formula, where an output is a mapping.
const FORMULA: &str = "formula";

/// Whether an output is a formula, with or without more about it.
pub fn is_formula(entry: &Entry) -> bool {
    match &entry.value.value {
        Value::Mapping(entries) => entries.iter().any(|entry| entry.key == FORMULA),
        _ => true,
    }
}

/// An output's formula, as if it stood alone, and its unit where one is named.
pub fn formula(reader: &mut Reader, entry: &Entry) -> Option<(Entry, Option<Node>)> {
    if !matches!(entry.value.value, Value::Mapping(_)) {
        return Some((entry.clone(), None));
    }
    let fields = reader.fields::<keys::OutputFormula>(&entry.value, entry.key_span.clone())?;
    let formula = reader.required(&fields, FORMULA)?.clone();
    Some((Entry { value: formula, ..entry.clone() }, fields.get("unit").cloned()))
}

/// Reads the unit in which an output is shown.
pub fn read(reader: &mut Reader, node: &Node, output: &str, dimension: Option<Dimension>) {
    let Some(unit) = parameters::unit(reader, node) else { return };
    let unit = DisplayUnit::new(node.scalar().map_or("", |scalar| &scalar.text), unit);
    match dimension {
        Some(dimension) if !unit.dimension().fits(dimension) => {
            let message = format!("`{output}` is {dimension}, and cannot be shown in `{}`", unit.text);
            let help = format!("a unit of {dimension}, or none: then it is shown in SI");
            reader.error(Code::WrongDimension, node.span.clone(), message, help);
        }
        _ => {
            reader.model.display.insert(output.to_owned(), unit);
        }
    }
}
