//! Tolerances of values that depend on uncertain parameters: `s2: { value: s, tolerance: 0.01 mm }` lies around s
//! wherever s is. The deviation is an uncertain parameter of its own, `s2.deviation`.

use symdiff::{Binary, Formula};

use super::spec::Spec;
use super::{ParameterDraft, interval, law, says_more, settle, unit};
use crate::expand::overrides::Override;
use crate::grammar::dimension::KnownDimension;
use crate::model::description::{Parameter, ParameterValue};
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::Entry;

const DEVIATION: &str = ".deviation";
const SEED: &str = ".seed";

/// Name of the parameter by which something of a name deviates.
pub fn deviation_of(name: &str) -> String {
    format!("{name}{DEVIATION}")
}

/// Name of the parameter that chooses the realisation of a random excitation.
pub fn seed_of(name: &str) -> String {
    format!("{name}{SEED}")
}

/// Index of the parameter whose deviation has this name.
pub fn owner(entries: &[Entry], name: &str) -> Option<usize> {
    let name = name.strip_suffix(DEVIATION)?;
    entries.iter().position(|entry| entry.key == name)
}

/// Adds the deviations of uncertain parameters whose values depend on uncertain ones. They may be set like parameters
/// of the file.
pub fn add_deviations(reader: &mut Reader, drafts: &mut Vec<ParameterDraft>, overrides: &[(Override, Span)]) {
    let varies = varying(reader, drafts);
    let own = drafts.len();
    for index in 0..own {
        let draft = &drafts[index];
        if !(draft.spec.is_uncertain() && !draft.spec.contradictory && draft.uses.iter().any(|&used| varies[used])) {
            continue;
        }
        let name = deviation_of(&reader.model.parameters[index].name);
        let set = overrides.iter().find(|(wanted, _)| wanted.name == name);
        let (name_span, unit_node) = (draft.name_span.clone(), draft.spec.unit.clone());
        let mut spec = Spec::of_unit(unit_node);
        if let Some((wanted, _)) = set {
            spec.replace(reader, &wanted.value);
        }
        let unit = spec.unit.as_ref().and_then(|node| unit(reader, node));
        let value = spec.value.as_ref().and_then(|node| reader.written(node));
        let deviation = drafts.len();
        drafts.push(ParameterDraft { spec, name_span, unit, value, uses: Vec::new(), deviation: None });
        let value = ParameterValue::Formula(Formula::number(f64::NAN));
        reader.model.parameters.push(Parameter { name, unit: String::new(), value });
        reader.used.push(false);
        reader.kinds.push(KnownDimension::Any);
        drafts[index].deviation = Some(deviation);
        drafts[index].uses.push(deviation);
    }
    for (wanted, span) in overrides.iter().filter(|(wanted, _)| wanted.name.ends_with(DEVIATION)) {
        if !reader.model.parameters.iter().any(|known| known.name == wanted.name) {
            let message = format!("`{}` has no deviation of its own", wanted.name.trim_end_matches(DEVIATION));
            let help = "a parameter with a tolerance whose value depends on an uncertain one has".to_owned();
            reader.error(Code::NotUncertain, span.clone(), message, help);
        }
    }
}

/// Whether each parameter is uncertain or free, or depends on one that is.
fn varying(reader: &Reader, drafts: &[ParameterDraft]) -> Vec<bool> {
    let is_free = |index: usize| reader.free.contains(&reader.model.parameters[index].name);
    let own = |(index, draft): (usize, &ParameterDraft)| draft.spec.is_uncertain() || is_free(index);
    let mut varies: Vec<bool> = drafts.iter().enumerate().map(own).collect();
    let mut users = vec![Vec::new(); drafts.len()];
    for (index, draft) in drafts.iter().enumerate() {
        draft.uses.iter().for_each(|&used| users[used].push(index));
    }
    let mut open: Vec<usize> = (0..drafts.len()).filter(|&index| varies[index]).collect();
    while let Some(varying) = open.pop() {
        for &user in &users[varying] {
            if !std::mem::replace(&mut varies[user], true) {
                open.push(user);
            }
        }
    }
    varies
}

/// A parameter whose value depends on uncertain ones, and which deviates from it.
pub struct Deviating<'f> {
    /// Index of the parameter.
    pub index: usize,
    /// Index of the parameter that is its deviation.
    pub deviation: usize,
    /// Its value without the deviation.
    pub formula: &'f Formula,
    /// That at the nominal values; `None` if unknown.
    pub nominal: Option<f64>,
}

/// Gives such a parameter its formula, and its deviation an interval; those that it uses have theirs.
pub fn finish(
    reader: &mut Reader,
    draft: &ParameterDraft,
    Deviating { index, deviation, formula, nominal }: Deviating<'_>,
    kind: &mut KnownDimension,
    values: &mut [f64],
) {
    if let Some(node) = &draft.spec.interval {
        let message = "the value depends on an uncertain parameter, so that this interval is not one around it";
        let help = "give a `tolerance`, or `plus` and `minus`".to_owned();
        reader.error(Code::BadTolerance, node.span.clone(), message, help);
        return;
    }
    let Some((above, below)) = interval::deviations(reader, draft, nominal, kind) else { return };
    let is_set = values[deviation].is_finite();
    if !is_set {
        values[deviation] = 0.0;
        let (lower, upper) = (-below, above);
        reader.model.parameters[deviation].value = if lower < upper {
            says_more(reader, draft, deviation, law::LawInterval { nominal: 0.0, lower, upper, written: None }, kind);
            ParameterValue::Interval { nominal: 0.0, lower, upper }
        } else {
            reader.certain.insert(reader.model.parameters[deviation].name.clone());
            ParameterValue::Formula(Formula::number(0.0))
        };
    }
    settle(reader, draft, deviation, *kind);
    values[index] = nominal.map_or(f64::NAN, |nominal| nominal + values[deviation]);
    let whole = formula.combined(Binary::Add, &Formula::name(&reader.model.parameters[deviation].name));
    reader.model.parameters[index].value = ParameterValue::Formula(whole);
    settle(reader, draft, index, *kind);
}
