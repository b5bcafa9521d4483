//! Questions about a motion after its end.

use super::description::ReducedKind;
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Value};

/// Reports reduced outputs and requirements of times that the motion does not reach. A window may end after the motion:
/// it then ends with it.
pub fn check(reader: &mut Reader, outputs: &[Entry], requirements: &[Entry]) {
    let end = reader.model.simulation.duration;
    // An analysis without a motion says so elsewhere.
    if end.is_nan() || end <= 0.0 {
        return;
    }
    let reduced = |entry: &Entry| {
        let own = reader.model.reduced.iter().find(|own| own.name == entry.key)?;
        let is_value = own.kind == ReducedKind::Value && own.to.is_finite();
        Some(if is_value { (own.to, own.to) } else { (own.from, own.to) })
    };
    let required = |entry: &Entry| reader.model.requirements.iter().find(|own| own.name == entry.key)?.times;
    let of_outputs = outputs.iter().filter_map(|entry| Some((entry, reduced(entry)?)));
    let of_requirements = requirements.iter().filter_map(|entry| Some((entry, required(entry)?)));
    let all: Vec<(&Entry, (f64, f64))> = of_outputs.chain(of_requirements).collect();
    for (entry, (from, to)) in all {
        let is_at = from == to;
        let message = match is_at {
            true if from < 0.0 => format!("the motion begins at 0 s, so it has no value at {from} s"),
            true if from > end * (1.0 + TUNING.same_time) => {
                format!("the motion ends at {end} s, so it has no value at {from} s")
            }
            false if from >= end => format!("the motion ends at {end} s, so it has no part from {from} s on"),
            _ => continue,
        };
        let keys: &[&str] = if is_at { &["at", "to"] } else { &["from"] };
        let help = "ask for an earlier time, or give `simulation` a longer `duration`".to_owned();
        reader.error(Code::BadTimes, place(entry, keys), message, help);
    }
}

/// The value of the first of some keys that an entry has; the entry's key else.
fn place(entry: &Entry, keys: &[&str]) -> Span {
    let Value::Mapping(fields) = &entry.value.value else { return entry.key_span.clone() };
    let found = keys.iter().find_map(|key| fields.iter().find(|field| field.key == *key));
    found.map_or_else(|| entry.key_span.clone(), |field| field.value.span.clone())
}
