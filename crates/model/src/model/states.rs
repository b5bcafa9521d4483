//! `states:`.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::description::{Analysis, Effect};
use super::effects;
use super::names::Reader;
use crate::elements::effects::{EffectKind, ForceElement, State};
use crate::grammar::report::Fields;
use crate::grammar::{Element, Sensor};
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node};

/// Makes the names of states known, which everything may speak of: those of the section, and of effects that are
/// states.
pub fn declare(reader: &mut Reader, entries: &[Entry], effects: &[Entry]) {
    entries.iter().for_each(|entry| reader.declared.add(&entry.key));
    for entry in effects {
        if EffectKind::value_ahead(reader, &entry.value).is_some() {
            reader.declared.add(&entry.key);
        }
    }
    for _ in 0..TUNING.unit_passes {
        let mut found = false;
        for (entry, is_effect) in
            entries.iter().map(|entry| (entry, false)).chain(effects.iter().map(|entry| (entry, true)))
        {
            let Some(place) = reader.declared.without_unit(&entry.key) else { continue };
            let ahead = match is_effect {
                true => EffectKind::value_ahead(reader, &entry.value),
                false => State::value_ahead(reader, &entry.value),
            };
            if let Some(Some(dimension)) = ahead {
                reader.declared.set(place, dimension);
                found = true;
            }
        }
        if !found {
            break;
        }
    }
}

/// Reads the states, once all else is known that their rates may speak of.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    report_loops(reader, entries);
    for entry in entries {
        if !reader.name(entry, "a state") {
            continue;
        }
        let is_effect = reader.model.effects.iter().any(|effect| effect.name == entry.key);
        let is_parameter = reader.model.parameters.iter().any(|parameter| parameter.name == entry.key);
        if is_effect || is_parameter {
            let other = if is_effect { "an effect" } else { "a parameter" };
            let message = format!("{other} is called `{}` too", clip(&entry.key));
            reader.error(Code::NameTaken, entry.key_span.clone(), message, "give the state another name".to_owned());
            continue;
        }
        let state = State::read_node(reader, &entry.value, entry.key_span.clone());
        effects::add(reader, &entry.key, state.map(Into::into));
    }
}

/// Reports rates that depend on one another.
fn report_loops(reader: &mut Reader, entries: &[Entry]) {
    let suffix = format!(".{}", Sensor::CHANGE.name());
    let text = |entry: &Entry| entry.value.get("rate").and_then(Node::scalar).map(|scalar| scalar.text.clone());
    let of_rates: Vec<(&Entry, String)> = entries
        .iter()
        .filter_map(|entry| Some((entry, text(entry)?)))
        .filter(|(_, text)| text.contains(&suffix))
        .collect();
    let mut needs: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (entry, text) in &of_rates {
        let is_of = |name: &str| {
            let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '.'));
            text.match_indices(name).any(|(at, _)| {
                !is_part(text[..at].chars().next_back()) && !is_part(text[at + name.len()..].chars().next())
            })
        };
        let others = of_rates.iter().map(|(other, _)| other.key.as_str());
        needs.insert(&entry.key, others.filter(|other| is_of(&format!("{other}{suffix}"))).collect());
    }
    let mut reported = BTreeSet::new();
    for (entry, _) in &of_rates {
        let Some(circle) = circle(&needs, &entry.key).filter(|circle| circle.iter().all(|name| reported.insert(*name)))
        else {
            continue;
        };
        let names = circle.iter().chain(&circle[..1]).map(|name| format!("`{}{suffix}`", clip(name)));
        let message = format!("rates of states depend on one another: {}", names.collect::<Vec<_>>().join(" → "));
        let help = "a rate may depend on states, not on rates in a circle: solve for one of them by hand".to_owned();
        let place = entry.value.get("rate").map_or(&entry.key_span, |node| &node.span).clone();
        reader.error(Code::Circle, place, message, help);
    }
}

/// A shortest cycle of dependencies.
fn circle<'n>(needs: &BTreeMap<&'n str, Vec<&'n str>>, first: &'n str) -> Option<Vec<&'n str>> {
    let mut came_from: BTreeMap<&str, &str> = BTreeMap::new();
    let mut next = VecDeque::from([first]);
    while let Some(name) = next.pop_front() {
        for &other in needs.get(name).into_iter().flatten() {
            if other == first {
                let mut path = vec![name];
                while path[path.len() - 1] != first {
                    path.push(came_from[path[path.len() - 1]]);
                }
                path.reverse();
                return Some(path);
            }
            if !came_from.contains_key(other) {
                came_from.insert(other, name);
                next.push_back(other);
            }
        }
    }
    None
}

/// Reports states that change at too many instants.
pub fn check_instants(reader: &mut Reader, effects: &[Entry]) {
    let duration = reader.model.simulation.duration;
    let shortest = |effect: &Effect| {
        let periods = effect.kind.states().into_iter().filter_map(|state| state.period);
        let period = periods.reduce(f64::min).filter(|period| duration / period > TUNING.instants)?;
        Some((effect.name.clone(), period))
    };
    let too_short: Vec<(String, f64)> = reader.model.effects.iter().filter_map(shortest).collect();
    for entry in effects {
        if let Some(&(_, period)) = too_short.iter().find(|(name, _)| *name == entry.key) {
            let message =
                format!("`{}` changes at {:.0e} instants in {duration} s: too many", entry.key, duration / period);
            let help = format!("a period of {:e} s makes 10000; make such a state continuous", duration / 1e4);
            reader.error(Code::TooLarge, entry.key_span.clone(), message, help);
        }
    }
}

/// Whether something of an effect changes at instants.
pub fn is_sampled(effect: &Effect) -> bool {
    effect.kind.states().iter().any(|state| state.period.is_some())
}

/// Reports states in kinematics, and sampled effects in modes.
pub fn check(reader: &mut Reader, fields: &Fields, effects: &[Entry]) {
    let analysis = reader.model.analysis;
    let sampled: Vec<&Effect> = reader.model.effects.iter().filter(|own| is_sampled(own)).collect();
    let first = effects.iter().find(|entry| sampled.iter().any(|own| own.name == entry.key));
    if let (Analysis::Modes(_), Some(entry)) = (analysis, first) {
        let message = format!("`{}` changes at instants, but modes need continuous states", clip(&entry.key));
        let help = "write it as a state or a filter, its period as a `delay` of half of it; or leave it out here, e.g. in a scene with `without`";
        reader.error(Code::WrongAnalysis, entry.key_span.clone(), message, help.to_owned());
    }
    if reader.model.states.is_empty() || analysis != Analysis::Kinematics {
        return;
    }
    let of_effects = effects.iter().find(|entry| reader.model.states.contains(&entry.key));
    let place = of_effects.map_or_else(|| fields.key_span("states"), |entry| entry.key_span.clone());
    let help =
        "leave them out here, e.g. in a scene with `without`, or ask for `analysis: motion`, `statics` or `modes`";
    reader.error(
        Code::WrongAnalysis,
        place,
        "states follow from forces and rates, and kinematics knows none",
        help.to_owned(),
    );
}
