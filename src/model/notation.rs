//! Numbers with tolerances, written in one piece, as the fields of a parameter's long form.

use crate::grammar::tolerance::{self, Deviation, Toleranced};
use crate::syntax::yaml::{Entry, Node, Value};

/// The fields `value`, `tolerance`, `interval`, `plus` and `minus` that a number in one piece stands for. What cannot be read is
/// the `value`, of which it is reported.
pub fn fields(node: &Node) -> Vec<Entry> {
    let Ok(Toleranced { value, deviation }) = tolerance::read(node) else { return vec![field("value", node.clone())] };
    let mut fields: Vec<Entry> = value.into_iter().map(|value| field("value", value)).collect();
    match deviation {
        None => {}
        Some(Deviation::Either(either)) => fields.push(field("tolerance", either)),
        Some(Deviation::Sides { plus, minus }) => fields.extend([field("plus", plus), field("minus", minus)]),
        Some(Deviation::Between(between)) => fields.push(field("interval", between)),
    }
    fields
}

/// The fields of a parameter, in whichever form it is written.
pub fn fields_of_parameter(node: &Node) -> Vec<Entry> {
    match &node.value {
        Value::Mapping(entries) => {
            let of_entry = |entry: &Entry| match entry.key.as_str() {
                "value" if entry.value.scalar().is_some() => fields(&entry.value),
                _ => vec![entry.clone()],
            };
            entries.iter().flat_map(of_entry).collect()
        }
        _ => fields(node),
    }
}

/// A field of a parameter.
pub fn field(key: &str, value: Node) -> Entry {
    Entry { key: key.to_owned(), key_span: value.span.clone(), value }
}
