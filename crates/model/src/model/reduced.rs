//! Outputs that are one number a motion: `stroke: { range: slider.x }`.

use symdiff::{Binary, Formula, Unary};

use super::description::{ReducedKind, ReducedOutput};
use super::display;
use super::results_by_name::{self, DimensionedFormula, RESULTS};
use crate::grammar::dimension::KnownDimension;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::suggest::{clip, list};
use crate::syntax::yaml::{Entry, Node, Value};

use ReducedKind::{
    Integral, LastWhen, Max, MaxAbs, Mean, Min, Overshoot, Range, Rms, Settling, Straightness, TimeOfMax, TimeOfMin,
    When,
};

/// The keys of the reductions.
const KINDS: [(&str, ReducedKind); 16] = [
    ("range", Range),
    ("max", Max),
    ("min", Min),
    ("max_abs", MaxAbs),
    ("final", ReducedKind::Value),
    ("value", ReducedKind::Value),
    ("mean", Mean),
    ("rms", Rms),
    ("integral", Integral),
    ("time_of_max", TimeOfMax),
    ("time_of_min", TimeOfMin),
    ("when", When),
    ("last_when", LastWhen),
    ("settling", Settling),
    ("overshoot", Overshoot),
    ("straightness", Straightness),
];

/// Keys that only some kinds have.
const OWN: [(&str, &[&str]); 4] =
    [("at", &["value"]), ("target", &["settling", "overshoot"]), ("band", &["settling"]), ("line", &["straightness"])];

/// Reports an output that is of a reduced output.
///
/// # Returns
/// Whether it is of none.
pub fn is_of_motion(reader: &mut Reader, entry: &Entry, reduced: &[&str]) -> bool {
    let mut scalars = Vec::new();
    collect(&entry.value, &mut scalars);
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    for (node, text) in scalars {
        let mut words = text.split(|c| !is_part(c));
        let Some(name) = words.find(|word| reduced.contains(word) && reader.symbol(word).is_none()) else { continue };
        let message = format!("`{name}` is one number a motion, but an output is taken from the motion itself");
        let help = format!("requirements may have formulas of reduced outputs: `small: 2*{name} <= 1 m`");
        reader.error(Code::NotHere, node.span.clone(), message, help);
        return false;
    }
    true
}

/// All texts in a value.
fn collect<'n>(node: &'n Node, into: &mut Vec<(&'n Node, &'n str)>) {
    match &node.value {
        Value::Sequence(items) => items.iter().for_each(|item| collect(item, into)),
        Value::Mapping(entries) => entries.iter().for_each(|entry| collect(&entry.value, into)),
        _ => into.extend(node.scalar().map(|scalar| (node, scalar.text.as_str()))),
    }
}

/// Whether an entry of `outputs:` is a reduced output.
pub fn is_one(entry: &Entry) -> bool {
    !display::is_formula(entry)
}

/// Reads a reduced output.
pub fn read(reader: &mut Reader, entry: &Entry) {
    let Some(fields) = reader.fields::<keys::Reduced>(&entry.value, entry.key_span.clone()) else { return };
    let mut asked = KINDS.into_iter().filter_map(|(key, kind)| Some((key, kind, fields.get(key)?)));
    let Some((key, kind, node)) = asked.next() else {
        let keys = KINDS.map(|(key, _)| key);
        if fields.lacks_all(&keys) {
            let help = format!("one of {}, with a formula: `stroke: {{ range: slider.x }}`", list(&keys));
            reader.error(
                Code::BadReducedOutput,
                entry.key_span.clone(),
                "a reduced output needs a quantity of the motion",
                help,
            );
        }
        return;
    };
    if let Some((second, ..)) = asked.next() {
        let message = format!("a reduced output is one number, but `{second}` is a second");
        reader.error(Code::BadReducedOutput, fields.key_span(second), message, "give it a name of its own".to_owned());
        return;
    }
    for (own, kinds) in OWN {
        if fields.get(own).is_some() && !kinds.contains(&key) {
            reader.error(Code::MisplacedKey, fields.key_span(own), format!("`{own}` has no meaning for `{key}`"), None);
        }
    }
    let times = times(reader, &fields);
    let found = sources(reader, &fields, key, kind, node);
    let (Some((from, mut to)), Some((sources, dimension))) = (times, found) else { return };
    if key == "value" {
        let Some(at) = reader.required(&fields, "at").and_then(|node| reader.number(node, Dimension::TIME)) else {
            return;
        };
        to = at;
    }
    let unit = dimension.map_or_else(String::new, Dimension::unit);
    let text = format!("{} of {}", key.replace('_', " "), written(node));
    let kind = if kind == Straightness && sources.len() == 1 { MaxAbs } else { kind };
    let name = entry.key.clone();
    if reader.model.outputs.iter().any(|known| known.name == name) {
        let message = format!("two outputs are called `{name}`: one is a part of a vector");
        reader.error(Code::NameTaken, entry.key_span.clone(), message, "give one of them another name".to_owned());
        return;
    }
    if let Some(node) = fields.get("unit") {
        display::read(reader, node, &name, dimension);
    }
    let of_results = results_by_name::are_named(&reader.model, std::iter::empty());
    reader.model.reduced.push(ReducedOutput {
        name,
        text,
        unit,
        dimension,
        kind,
        sources,
        outputs: Vec::new(),
        from,
        to,
        of_results,
    });
}

/// A value as it is written.
fn written(node: &Node) -> String {
    match &node.value {
        Value::Sequence(items) => format!("[{}]", items.iter().map(written).collect::<Vec<_>>().join(", ")),
        _ => node.scalar().map_or_else(String::new, |scalar| scalar.text.trim().to_owned()),
    }
}

/// `from` and `to`.
pub(super) fn times(reader: &mut Reader, fields: &Fields) -> Option<(f64, f64)> {
    let from = fields.get("from").map_or(Some(0.0), |node| reader.number(node, Dimension::TIME))?;
    let to = fields.get("to").map_or(Some(f64::INFINITY), |node| reader.number(node, Dimension::TIME))?;
    if from < 0.0 || from >= to {
        let key = if fields.get("from").is_some() { "from" } else { "to" };
        let message = format!("the time from {from} s to {to} s is empty");
        reader.error(
            Code::BadReducedOutput,
            fields.key_span(key),
            message,
            "`from` is not negative, and before `to`".to_owned(),
        );
        return None;
    }
    Some((from, to))
}

/// The formulas of which something is taken, and the dimension of that.
fn sources(
    reader: &mut Reader,
    fields: &Fields,
    key: &str,
    kind: ReducedKind,
    node: &Node,
) -> Option<(Vec<Formula>, Option<Dimension>)> {
    match kind {
        When | LastWhen => {
            let comparison = comparison(reader, node)?;
            Some((vec![comparison.slack()], Some(Dimension::TIME)))
        }
        Straightness => straightness(reader, fields, node),
        Settling => {
            let own = source(reader, node)?;
            let [target, band] = ["target", "band"].map(|key| reader.required(fields, key));
            let (target, wide) = (target?, band?);
            let [target, band] = [target, wide].map(|node| like(reader, node, own.dimension));
            let width = band.as_ref().and_then(|band| reader.evaluate(band, 0));
            if width.is_some_and(|width| width <= 0.0) {
                let help = "it is how far from `target` the output may be, to either side".to_owned();
                reader.error(Code::OutOfRange, wide.span.clone(), "a band is positive", help);
                return None;
            }
            let off = own.formula.combined(Binary::Sub, &target?).applied(Unary::Abs);
            Some((vec![off.combined(Binary::Sub, &band?)], Some(Dimension::TIME)))
        }
        Overshoot => {
            let own = source(reader, node)?;
            let target = match fields.get("target") {
                Some(node) => Some(like(reader, node, own.dimension)?),
                None => None,
            };
            Some(([own.formula].into_iter().chain(target).collect(), own.dimension))
        }
        _ => {
            let own = source(reader, node)?;
            let dimension = match key {
                "integral" => own.dimension.map(|dimension| dimension.times(Dimension::TIME)),
                "time_of_max" | "time_of_min" => Some(Dimension::TIME),
                _ => own.dimension,
            };
            Some((vec![own.formula], dimension))
        }
    }
}

/// A path, or its comparison with a line.
fn straightness(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<(Vec<Formula>, Option<Dimension>)> {
    if let Some(line) = fields.get("line") {
        let own = source(reader, node)?;
        let line = like(reader, line, own.dimension)?;
        return Some((vec![own.formula.combined(Binary::Sub, &line)], own.dimension));
    }
    let [x, y] = reader.two(node, "abscissa and ordinate of a path: [foot.x, foot.y]")?;
    let (x, y) = (source(reader, x)?, source(reader, y)?);
    if let (Some(first), Some(second)) = (x.dimension, y.dimension) {
        reader.check_fits(&node.span, second, first);
    }
    Some((vec![x.formula, y.formula], y.dimension))
}

/// A formula of everything and of outputs by their names, which refers to the motion.
fn source(reader: &mut Reader, node: &Node) -> Option<DimensionedFormula> {
    let found = formula_of_outputs(reader, node)?;
    if found.formula.names().next().is_none() {
        reader.error(Code::ConstantOutput, node.span.clone(), "constant output: it refers to no variable", None);
    }
    Some(found)
}

/// A formula of the same dimension.
fn like(reader: &mut Reader, node: &Node, wanted: Option<Dimension>) -> Option<Formula> {
    let found = formula_of_outputs(reader, node)?;
    if let (Some(found), Some(wanted)) = (found.dimension, wanted) {
        reader.check_fits(&node.span, found, wanted);
    }
    Some(found.formula)
}

/// A formula of everything and of outputs by their names.
pub(super) fn formula_of_outputs(reader: &mut Reader, node: &Node) -> Option<DimensionedFormula> {
    let length = reader.scalar(node, "a formula")?.text.len();
    part(reader, node, 0..length)
}

/// The formula in a part of a scalar.
fn part(reader: &mut Reader, node: &Node, range: std::ops::Range<usize>) -> Option<DimensionedFormula> {
    let scalar = reader.scalar(node, "a formula")?;
    let parsed = reader.parse(node, scalar, range.clone())?;
    if results_by_name::are_named(&reader.model, parsed.names().map(|(name, _)| name)) {
        return results_by_name::part(reader, node, range, &RESULTS);
    }
    reader.refuse_like_names(node);
    let outputs = &reader.model.outputs;
    let formula = parsed
        .with_names(|name| outputs.iter().find(|output| output.name == name).map(|output| output.formula.clone()));
    reader.check_names(node, &formula, range.start, Context::Output).then_some(())?;
    let dimension = match reader.kind(node, &formula, range.start) {
        KnownDimension::Known { dimension, .. } => Some(dimension),
        KnownDimension::Number(_) | KnownDimension::Any => None,
    };
    Some(DimensionedFormula { formula, dimension })
}

/// Two formulas that are compared.
pub(super) struct Comparison {
    pub sides: [DimensionedFormula; 2],
    /// Whether the left side is to be the smaller one.
    pub is_upper: bool,
}

impl Comparison {
    /// Not negative where the comparison holds.
    pub fn slack(&self) -> Formula {
        let [left, right] = &self.sides;
        let (larger, smaller) = if self.is_upper { (right, left) } else { (left, right) };
        larger.formula.combined(Binary::Sub, &smaller.formula)
    }
}

/// The only `<`, `<=`, `>` or `>=` of a text: its index, its length, and whether it is one of the first two.
pub(super) fn relation(reader: &mut Reader, node: &Node) -> Option<(usize, usize, bool)> {
    let text = &reader.scalar(node, "a comparison")?.text;
    let signs: Vec<usize> =
        text.char_indices().filter(|(_, c)| matches!(c, '<' | '>')).map(|(index, _)| index).collect();
    let [index] = signs.as_slice() else {
        let message = format!("`{}` is not a comparison", clip(text));
        reader.error(
            Code::BadRequirement,
            node.span.clone(),
            message,
            "write one of `<=`, `>=`, `<` and `>` between two formulas".to_owned(),
        );
        return None;
    };
    let length = if text[index + 1..].starts_with('=') { 2 } else { 1 };
    Some((*index, length, text[*index..].starts_with('<')))
}

/// Reads `door.angle > 1.2`.
pub(super) fn comparison(reader: &mut Reader, node: &Node) -> Option<Comparison> {
    let (index, length, is_upper) = relation(reader, node)?;
    let text = &reader.scalar(node, "a comparison")?.text;
    let sides = [part(reader, node, 0..index), part(reader, node, index + length..text.len())];
    let [left, right] = sides;
    let sides = [left?, right?];
    if let (Some(first), Some(second)) = (sides[0].dimension, sides[1].dimension) {
        reader.check_fits(&node.span, second, first);
    }
    Some(Comparison { sides, is_upper })
}
