//! Requirements on outputs: `clears: x3 >= 0.4 m`.

use symdiff::{Binary, Formula, Unary};

use super::description::{Limit, Requirement};
use super::reduced;
use super::results_by_name::{self, DimensionedFormula, REDUCED};
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Node, Value};

/// Two sides of a comparison.
struct Limited {
    /// The limited quantity, as it is written.
    of: String,
    own: DimensionedFormula,
    limit: DimensionedFormula,
    is_upper: bool,
}

/// Reads `requirements:`.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "a requirement");
        let found = match &entry.value.value {
            Value::Mapping(_) => of_mapping(reader, entry),
            _ => of_text(reader, &entry.value, entry),
        };
        if let Some(found) = found {
            reader.model.requirements.push(found);
        }
    }
}

/// `x3 >= 0.4 m`.
fn of_text(reader: &mut Reader, node: &Node, entry: &Entry) -> Option<Requirement> {
    let (place, length, is_upper) = reduced::relation(reader, node)?;
    let scalar = reader.scalar(node, "a comparison")?;
    let text = scalar.text.trim().to_owned();
    let of = scalar.text[..place].trim().to_owned();
    let sides = [0..place, place + length..scalar.text.len()];
    let of_reduced = sides.iter().any(|range| names_reduced(reader, &scalar.text[range.clone()]));
    let [own, limit] = if of_reduced {
        sides.map(|range| results_by_name::part(reader, node, range, &REDUCED))
    } else {
        let comparison = reduced::comparison(reader, node)?;
        comparison.sides.map(Some)
    };
    let (own, limit) = (own?, limit?);
    if let (true, Some(found), Some(wanted)) = (of_reduced, limit.dimension, own.dimension) {
        reader.check_fits(&node.span, found, wanted);
    }
    let limited = Limited { of, own, limit, is_upper };
    Some(required(reader, entry, text, vec![limited], of_reduced, (0.0, f64::INFINITY)))
}

/// `{ output: peak, max: 250 N }`, or `{ that: "x3 >= 0.4 m", from: 0.1 }`.
fn of_mapping(reader: &mut Reader, entry: &Entry) -> Option<Requirement> {
    let fields = reader.fields::<keys::Requirement>(&entry.value, entry.key_span.clone())?;
    let times = times(reader, &fields)?;
    if let Some(node) = fields.get("that") {
        for key in ["output", "max", "min"] {
            reader.exclude(&fields, [key, "that"]);
        }
        let found = of_text(reader, node, entry)?;
        return timed(reader, &fields, found, times);
    }
    let node = reader.required(&fields, "output")?;
    let of = reader.scalar(node, "an output")?.text.trim().to_owned();
    let limits: Vec<(&str, &Node)> =
        ["max", "min"].into_iter().filter_map(|key| Some((key, fields.get(key)?))).collect();
    if limits.is_empty() {
        if fields.lacks_all(&["max", "min"]) {
            reader.error(
                Code::IncompleteElement,
                entry.key_span.clone(),
                "a requirement needs `max`, `min` or both",
                None,
            );
        }
        return None;
    }
    let of_reduced = names_reduced(reader, &of);
    let (mut limited, mut texts) = (Vec::new(), Vec::new());
    for (key, limit) in limits {
        let own = side(reader, node, of_reduced)?;
        let found = side(reader, limit, of_reduced)?;
        if let (Some(found), Some(wanted)) = (found.dimension, own.dimension) {
            reader.check_fits(&limit.span, found, wanted);
        }
        let is_upper = key == "max";
        let sign = if is_upper { "<=" } else { ">=" };
        texts.push(format!("{of} {sign} {}", limit.scalar().map_or("", |scalar| scalar.text.trim())));
        limited.push(Limited { of: of.clone(), own, limit: found, is_upper });
    }
    let bound = |is_upper: bool| {
        let limit = &limited.iter().find(|limited| limited.is_upper == is_upper)?.limit.formula;
        reader.evaluate(limit, 0).filter(|_| !reader.is_uncertain(limit))
    };
    if let (Some(max), Some(min)) = (bound(true), bound(false))
        && max < min
    {
        let message = format!("no value is between `min` and `max`: {min} is above {max}");
        reader.error(Code::ReversedRange, fields.key_span("max"), message, "`min` is the smaller one".to_owned());
        return None;
    }
    let found = required(reader, entry, texts.join(" and "), limited, of_reduced, times);
    timed(reader, &fields, found, times)
}

/// A side of a comparison of reduced outputs, or of outputs over time.
fn side(reader: &mut Reader, node: &Node, of_reduced: bool) -> Option<DimensionedFormula> {
    match of_reduced {
        true => {
            let length = reader.scalar(node, "a formula")?.text.len();
            results_by_name::part(reader, node, 0..length, &REDUCED)
        }
        false => reduced::formula_of_outputs(reader, node),
    }
}

/// How far a quantity is below zero, or above it: its worst value is the margin with the other sign.
pub(super) fn distance_from_zero(reader: &mut Reader, entry: &Entry, is_upper: bool) -> Option<Requirement> {
    let of = reader.scalar(&entry.value, "an output")?.text.trim().to_owned();
    let of_reduced = names_reduced(reader, &of);
    let own = side(reader, &entry.value, of_reduced)?;
    let limit = DimensionedFormula { formula: Formula::number(0.0), dimension: own.dimension };
    let limited = Limited { of: of.clone(), own, limit, is_upper };
    let found = required(reader, entry, of, vec![limited], of_reduced, (0.0, f64::INFINITY));
    Some(Requirement { limits: Vec::new(), ..found })
}

/// `from` and `to`, or `at`.
fn times(reader: &mut Reader, fields: &Fields) -> Option<(f64, f64)> {
    reader.exclude(fields, ["at", "from"]);
    reader.exclude(fields, ["at", "to"]);
    match fields.get("at") {
        Some(node) => reader.number(node, Dimension::TIME).map(|at| (at, at)),
        None => reduced::times(reader, fields),
    }
}

/// The same at other times, with these in its text.
fn timed(reader: &mut Reader, fields: &Fields, found: Requirement, (from, to): (f64, f64)) -> Option<Requirement> {
    let Some(key) = ["at", "from", "to"].into_iter().find(|key| fields.get(key).is_some()) else { return Some(found) };
    if found.times.is_none() {
        let help = "give the reduced output its own `from` and `to`".to_owned();
        reader.error(
            Code::MisplacedKey,
            fields.key_span(key),
            format!("`{key}` has no meaning for one number per motion"),
            help,
        );
        return None;
    }
    let mut text = found.text;
    let mut add = |key: &str, time: f64| {
        if fields.get(key).is_some() {
            text += &format!(" {key} {time} s");
        }
    };
    add("at", from);
    add("from", from);
    add("to", to);
    Some(Requirement { text, times: Some((from, to)), ..found })
}

/// Slacks and limits.
fn required(
    reader: &Reader,
    entry: &Entry,
    text: String,
    limited: Vec<Limited>,
    of_reduced: bool,
    times: (f64, f64),
) -> Requirement {
    let (mut slacks, mut limits) = (Vec::new(), Vec::new());
    let dimension = limited.iter().find_map(|limited| limited.own.dimension.or(limited.limit.dimension));
    let display = declared(reader, &limited[0].of, dimension);
    for Limited { of, own, limit, is_upper } in limited {
        let constant = reader.evaluate(&limit.formula, 0).filter(|_| !reader.is_uncertain(&limit.formula));
        let mut note = |of: &str, sign: f64, is_upper: bool| {
            limits.extend(constant.map(|value| Limit { of: of.to_owned(), value: sign * value, is_upper }));
        };
        // A magnitude has a kink at zero, its two sides have none.
        match own.formula.argument_of(Unary::Abs).filter(|_| is_upper) {
            Some(inside) => {
                slacks.push(limit.formula.combined(Binary::Sub, &inside));
                slacks.push(limit.formula.combined(Binary::Add, &inside));
                let inner = of.trim_start_matches("abs(").trim_end_matches(')');
                note(inner, 1.0, true);
                note(inner, -1.0, false);
            }
            None => {
                let (larger, smaller) = if is_upper { (&limit, &own) } else { (&own, &limit) };
                slacks.push(larger.formula.combined(Binary::Sub, &smaller.formula));
                note(&of, 1.0, is_upper);
            }
        }
    }
    let names: Vec<&str> = slacks.iter().flat_map(Formula::names).map(|(name, _)| name).collect();
    let of_results = !of_reduced && results_by_name::are_named(&reader.model, names.iter().copied());
    let unit = dimension.map_or_else(String::new, Dimension::unit);
    let unit = results_by_name::unit(names.into_iter()).filter(|_| of_results).map_or(unit, str::to_owned);
    if of_results {
        slacks = slacks.iter().flat_map(|slack| results_by_name::at_frequencies(&reader.model, slack)).collect();
    }
    let times = (!of_reduced).then_some(times);
    let name = entry.key.clone();
    Requirement { name, text, unit, display, slacks, outputs: Vec::new(), times, limits, of_results }
}

/// Names and numbers of a formula.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.')))
}

/// The unit that the model declares for the first output of the limited quantity, where the margin has its dimension.
fn declared(reader: &Reader, of: &str, dimension: Option<Dimension>) -> Option<DisplayUnit> {
    let unit = words(of).find_map(|word| reader.model.display.get(word))?;
    dimension.is_none_or(|dimension| unit.dimension().fits(dimension)).then(|| unit.clone())
}

/// Whether a text names a reduced output.
fn names_reduced(reader: &Reader, text: &str) -> bool {
    words(text).any(|word| reader.model.reduced.iter().any(|reduced| reduced.name == word))
}
