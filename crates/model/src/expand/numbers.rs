//! Numbers of a robot's file as parameters of the model: those that something names, with their deviations in the model
//! or in attributes of the file.

use std::collections::{HashMap, HashSet};

use crate::expand::notation::{self, field};
use crate::expand::overrides::Override;
use crate::grammar::report::Report;
use crate::grammar::unit::{Unit, number_and_unit};
use crate::robots::number::Number;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Format of a robot's file: its name in messages, and the names of its numbers.
pub struct Format {
    pub name: &'static str,
    /// Examples of names.
    pub forms: &'static str,
    /// Whether a parameter's name is that of a number.
    pub is_number: fn(&str) -> bool,
}

/// Every word of the model, and the parts of names with dots.
pub fn words(root: &Node, overrides: &[(Override, Span)]) -> HashSet<String> {
    let mut words = HashSet::new();
    let mut take = |text: &str| {
        for word in text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.')) {
            words.insert(word.to_owned());
            words.extend(word.split('.').map(str::to_owned));
        }
    };
    let mut open = vec![root];
    while let Some(node) = open.pop() {
        match &node.value {
            Value::Scalar(scalar) => take(&scalar.text),
            Value::Sequence(items) => open.extend(items),
            Value::Mapping(entries) => {
                for entry in entries {
                    take(&entry.key);
                    open.push(&entry.value);
                }
            }
        }
    }
    overrides.iter().for_each(|(wanted, _)| take(&wanted.name));
    words
}

/// The model's parameters, those of the robot first that are named or have an attribute.
pub fn entries<'n>(
    report: &mut Report,
    format: &Format,
    numbers: impl Iterator<Item = &'n Number>,
    words: &HashSet<String>,
    written: &[Entry],
) -> Vec<Entry> {
    let by_key: HashMap<&str, &Entry> = written.iter().map(|entry| (entry.key.as_str(), entry)).collect();
    let mut entries = Vec::new();
    let mut known = HashSet::new();
    for number in numbers {
        known.insert(number.name.as_str());
        let entry = by_key.get(number.name.as_str()).copied();
        if entry.is_some() || number.uncertain.is_some() || words.contains(&number.name) {
            entries.push(parameter(report, number, entry));
        }
    }
    for entry in written {
        if !(format.is_number)(&entry.key) {
            entries.push(entry.clone());
        } else if !known.contains(entry.key.as_str()) {
            let message = format!("the {} has no number `{}`", format.name, clip(&entry.key));
            let help = suggest::nearest(&entry.key, known.iter().copied());
            let help = help.map_or_else(|| format.forms.to_owned(), |near| format!("did you mean `{near}`?"));
            report.error(Code::UnknownName, entry.key_span.clone(), message, help);
        }
    }
    entries
}

fn parameter(report: &mut Report, number: &Number, written: Option<&Entry>) -> Entry {
    let mut fields = match (written, &number.uncertain) {
        (Some(entry), _) => notation::fields_of_parameter(&entry.value),
        (None, Some((text, span))) => {
            let fields = notation::fields(&scalar(text.clone(), span.clone(), Some(span.start)));
            if fields.iter().any(|field| field.key == "value") {
                let message = format!("`{}` says no deviation", clip(text));
                report.error(
                    Code::BadTolerance,
                    span.clone(),
                    message,
                    "write `5%`, `± 0.1` or `[lower, upper]`".to_owned(),
                );
            }
            fields
        }
        (None, None) => Vec::new(),
    };
    let (key_span, value_span) = match written {
        Some(entry) => (entry.key_span.clone(), entry.value.span.clone()),
        None => (number.span.clone(), number.span.clone()),
    };
    let has = |key: &str| fields.iter().any(|field| field.key == key);
    let outside = fields.iter().find(|field| field.key == "interval").is_some_and(|field| !holds(&field.value, number));
    let (value, unit) = (!has("value") && !outside, !has("unit") && !number.unit.is_empty());
    if value {
        fields.push(field("value", scalar(format!("{:?}", number.value), value_span.clone(), None)));
    }
    if unit {
        fields.push(field("unit", scalar(number.unit.to_owned(), value_span.clone(), None)));
    }
    Entry { key: number.name.clone(), key_span, value: Node { span: value_span, value: Value::Mapping(fields) } }
}

/// Whether an interval has the file's number in it, which is then the nominal one.
fn holds(interval: &Node, number: &Number) -> bool {
    let Value::Sequence(ends) = &interval.value else { return false };
    let in_si = |end: &Node| {
        let text = end.scalar()?.text.trim();
        match number_and_unit(text) {
            Some((value, unit, _)) => Some(Unit::parse(unit).ok()?.to_si(value)),
            None => text.parse().ok(),
        }
    };
    let ends: Vec<f64> = ends.iter().filter_map(in_si).collect();
    matches!(ends.as_slice(), [lower, upper] if (*lower..=*upper).contains(&number.value))
}

fn scalar(text: String, span: Span, start: Option<usize>) -> Node {
    Node { span, value: Value::Scalar(Scalar::plain(text, start)) }
}
