//! `design:` and `objective:`.

use super::description::{Design, Free, Objective};
use super::parameters::Riding;
use super::requirements;
use crate::grammar::formulas::{Written, evaluate};
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::tolerance;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Help for a range that cannot be read.
const RANGE: &str = "e.g. `0.2 to 0.3 m`, or `[0.2, 0.3] m`";

/// Notes the names of free parameters, before parameters are read.
pub fn declare(reader: &mut Reader, fields: &Fields) {
    let entries = entries(fields);
    reader.free.extend(entries.iter().map(|entry| entry.key.clone()));
}

fn entries<'n>(fields: &Fields<'n>) -> &'n [Entry] {
    match fields.get("design").map(|node| &node.value) {
        Some(Value::Mapping(entries)) => entries,
        _ => &[],
    }
}

/// Reads both sections; parameters, outputs and requirements are known.
pub fn read(reader: &mut Reader, fields: &Fields, riding: &[Riding]) {
    let (design, objective) = match (fields.get("design"), fields.get("objective")) {
        (None, None) => return,
        (Some(_), None) => {
            let help = "e.g. `objective: { least: error }`, or `objective: margin`";
            let message = "`design` needs an `objective` for the free values";
            reader.error(Code::BadDesign, fields.key_span("design"), message, help.to_owned());
            return;
        }
        (None, Some(_)) => {
            let message = "an `objective` needs a `design`: which nominal values are free";
            reader.error(
                Code::BadDesign,
                fields.key_span("objective"),
                message,
                "e.g. `design: { rod: 0.2 to 0.3 m }`".to_owned(),
            );
            return;
        }
        (Some(design), Some(objective)) => (design, objective),
    };
    if !matches!(&design.value, Value::Mapping(entries) if !entries.is_empty()) {
        let help = "e.g. `design: { rod: 0.2 to 0.3 m }`".to_owned();
        reader.error(Code::BadDesign, design.span.clone(), "free parameters with their ranges belong here", help);
        return;
    }
    let free: Vec<Free> = entries(fields).iter().filter_map(|entry| read_free(reader, entry, riding)).collect();
    let Some(objective) = read_objective(reader, objective, fields) else { return };
    if !free.is_empty() {
        reader.model.design = Some(Design { free, objective });
    }
}

fn read_free(reader: &mut Reader, entry: &Entry, riding: &[Riding]) -> Option<Free> {
    let name = &entry.key;
    let at = entry.key_span.clone();
    reader.mentions(Some(NameKind::Parameter), name, &at);
    let Some(own) = riding.iter().find(|own| own.name == *name) else {
        let known: Vec<String> = reader.model.parameters.iter().map(|own| own.name.clone()).collect();
        let help = suggest::help(name, "parameters", known.iter().map(String::as_str));
        reader.error(Code::UnknownName, at, format!("unknown parameter `{}`", clip(name)), help);
        return None;
    };
    if !own.is_number {
        let help = "free the parameters that its formula names".to_owned();
        reader.error(
            Code::BadDesign,
            at,
            format!("`{}` follows from other parameters: its value is not free", clip(name)),
            help,
        );
        return None;
    }
    if own.has_class {
        let help = "give the deviations themselves, e.g. `+0.018 mm -0`".to_owned();
        let message = format!("the tolerance class of `{}` depends on the size, which is free", clip(name));
        reader.error(Code::BadDesign, at, message, help);
        return None;
    }
    let [lower, upper] = range(reader, name, &entry.value)?;
    Some(Free { name: name.clone(), lower, upper, relative: own.relative })
}

/// The ends of a range, SI.
fn range(reader: &mut Reader, name: &str, node: &Node) -> Option<[f64; 2]> {
    let ends = match tolerance::range(node) {
        Ok(Some(ends)) => ends,
        Ok(None) => {
            reader.error(
                Code::BadDesign,
                node.span.clone(),
                "a range of nominal values belongs here",
                RANGE.to_owned(),
            );
            return None;
        }
        Err(error) => {
            reader.diagnostics.push(*error);
            return None;
        }
    };
    let index = reader.model.parameters.iter().position(|own| own.name == name)?;
    let dimension = reader.kinds[index].dimension();
    let [lower, upper] = ends.each_ref().map(|end| limit(reader, end, dimension));
    let (lower, upper) = (lower?, upper?);
    if lower >= upper {
        let message = format!("the range is empty: {lower} is not below {upper}");
        reader.error(Code::ReversedRange, node.span.clone(), message, "the smaller end stands first".to_owned());
        return None;
    }
    Some([lower, upper])
}

/// An end of a range, SI.
fn limit(reader: &mut Reader, node: &Node, dimension: Option<Dimension>) -> Option<f64> {
    match reader.written(node)? {
        Written::Quantity { value, unit } => {
            let fits = dimension.is_none_or(|dimension| reader.check_fits(&node.span, unit.dimension, dimension));
            fits.then(|| unit.to_si(value))
        }
        Written::Formula(formula) => {
            let number = evaluate(&formula, |_| None).filter(|number| number.is_finite());
            if number.is_none() {
                reader.error(Code::BadDesign, node.span.clone(), "the ends of a range are numbers", RANGE.to_owned());
            } else if dimension.is_some_and(|dimension| !dimension.fits(Dimension::NUMBER)) {
                reader.error(
                    Code::MissingUnit,
                    node.span.clone(),
                    "this number has no unit, but the parameter has",
                    RANGE.to_owned(),
                );
                return None;
            }
            number
        }
    }
}

fn read_objective(reader: &mut Reader, node: &Node, fields: &Fields) -> Option<Objective> {
    let help = "`margin`, `cost`, `{ least: OUTPUT }` and `{ most: OUTPUT }`";
    if let Value::Mapping(entries) = &node.value {
        let own = reader.fields::<keys::ObjectiveKinds>(node, fields.key_span("objective"))?;
        let given: Vec<&Entry> =
            entries.iter().filter(|entry| matches!(entry.key.as_str(), "least" | "most")).collect();
        let [entry] = given.as_slice() else {
            if !given.is_empty() || own.lacks_all(&["least", "most"]) {
                reader.error(
                    Code::BadDesign,
                    node.span.clone(),
                    "an objective is one output",
                    "`{ least: OUTPUT }` or `{ most: OUTPUT }`".to_owned(),
                );
            }
            return None;
        };
        let is_largest = entry.key == "least";
        let distance = requirements::distance_from_zero(reader, entry, is_largest)?;
        return Some(Objective::Worst { is_largest, distance: Box::new(distance) });
    }
    let scalar = reader.scalar(node, "an objective")?;
    let (objective, lacking) = match scalar.text.trim() {
        "margin" => (Objective::Margin, "a margin is that of requirements, and the model has none"),
        "cost" => (Objective::Cost, "tolerances are as cheap as requirements allow, and the model has none"),
        other => {
            let message = format!("`{}` is no objective", clip(other));
            reader.error(Code::BadDesign, node.span.clone(), message, format!("objectives are {help}"));
            return None;
        }
    };
    if reader.model.requirements.is_empty() {
        let help = "e.g. `requirements: { clears: x >= 0.4 m }`".to_owned();
        reader.error(Code::BadDesign, node.span.clone(), lacking, help);
        return None;
    }
    if matches!(objective, Objective::Cost) && !reader.model.statistics.is_priced() {
        let help = "e.g. `rod: { value: 0.2 m, tolerance: 0.1 mm, cost: { reciprocal: 2 } }`".to_owned();
        reader.error(
            Code::BadDesign,
            node.span.clone(),
            "the cost is that of tolerances, and no parameter has a `cost`",
            help,
        );
        return None;
    }
    Some(objective)
}

/// Reports free parameters that nothing reads; in a variant that omits parts, they are not free.
pub fn check_used(reader: &mut Reader, fields: &Fields, unused: &[Diagnostic], is_partial: bool) {
    let Some(design) = &mut reader.model.design else { return };
    if is_partial {
        let idle = &reader.idle;
        design.free.retain(|free| !idle.contains(&free.name));
        if design.free.is_empty() {
            reader.model.design = None;
        }
        return;
    }
    for entry in entries(fields) {
        let message = format!("parameter `{}` is used nowhere", clip(&entry.key));
        if unused.iter().any(|warning| warning.message == message) {
            let message = format!("`{}` is free, but nothing depends on it", clip(&entry.key));
            reader.error(
                Code::BadDesign,
                entry.key_span.clone(),
                message,
                "leave it out of `design`, or use it".to_owned(),
            );
        }
    }
}
