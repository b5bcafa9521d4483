//! `parameters:` and the `--set` that replace them.

mod corners;
mod cost;
mod dependent;
mod interval;
pub(super) mod law;
mod order;
mod spec;

pub use dependent::{deviation_of, seed_of};

use std::collections::{HashMap, HashSet};

use symdiff::Formula;

use self::spec::Spec;
use super::description::{Parameter, ParameterValue};
use crate::expand::notation;
use crate::expand::overrides::Override;
use crate::grammar::Symbol;
use crate::grammar::dimension::KnownDimension;
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::formulas::{Written, evaluate};
use crate::grammar::names::Context;
use crate::grammar::unit::{Unit, number_and_unit};
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::robots::{mjcf, urdf};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest;
use crate::syntax::yaml::{Entry, Node};

/// Whether a name is that of a number of a robot's file.
fn is_of_robot(name: &str) -> bool {
    urdf::is_number(name) || mjcf::is_number(name)
}

/// A parameter between its text and its value.
pub(super) struct ParameterDraft {
    spec: Spec,
    name_span: Span,
    unit: Option<Unit>,
    value: Option<Written>,
    /// Parameters that the value's formula names.
    uses: Vec<usize>,
    /// The parameter that is its own deviation, where its value depends on an uncertain one.
    deviation: Option<usize>,
}

/// How the tolerance of a parameter whose nominal value is free goes with that.
pub(super) struct Riding {
    /// Its name.
    pub name: String,
    /// Whether its value is a number, and no formula of others.
    pub is_number: bool,
    /// Whether a tolerance class gives the deviations, by the size.
    pub has_class: bool,
    /// Whether the deviations upwards and downwards are shares of the value.
    pub relative: [bool; 2],
}

/// Reads the parameters; after this, formulas of them can be checked and evaluated. Returns those that are free.
pub(super) fn read(reader: &mut Reader, entries: &[Entry], overrides: &[(Override, Span)]) -> Vec<Riding> {
    let mut entries = entries;
    let mut own = entries.iter().enumerate().filter(|(_, entry)| !is_of_robot(&entry.key));
    if let Some((first, entry)) = own.nth(TUNING.parameters) {
        reader.error(
            Code::TooLarge,
            entry.key_span.clone(),
            format!("the model has more than {parameters} parameters", parameters = TUNING.parameters),
            None,
        );
        entries = &entries[..first];
    }
    let replaced = find_overrides(reader, entries, overrides);
    for entry in entries {
        if !is_of_robot(&entry.key) {
            reader.name(entry, "a parameter");
        }
        // NaN until it is known: no file can write that.
        let value = ParameterValue::Formula(Formula::number(f64::NAN));
        reader.model.parameters.push(Parameter { name: entry.key.clone(), unit: String::new(), value });
    }
    reader.used = vec![false; entries.len()];
    reader.kinds = vec![KnownDimension::Any; entries.len()];
    let mut drafts: Vec<ParameterDraft> =
        entries.iter().enumerate().map(|(index, entry)| draft(reader, entry, replaced.get(&index).copied())).collect();
    dependent::add_deviations(reader, &mut drafts, overrides);
    let order = order::in_order(reader, &drafts);
    let mut values = vec![f64::NAN; drafts.len()];
    for &index in &order {
        finish(reader, &drafts[index], index, &mut values);
    }
    sort(reader, &order);
    let places: Vec<Span> = order.iter().map(|&index| drafts[index].name_span.clone()).collect();
    let free = entries.iter().zip(&drafts).filter(|(entry, _)| reader.free.contains(&entry.key));
    let riding = free.map(|(entry, draft)| riding(&entry.key, draft)).collect();
    corners::read(reader, &places);
    let none = vec![false; drafts.len()];
    reader.used_by_parameters = std::mem::replace(&mut reader.used, none);
    riding
}

fn riding(name: &str, draft: &ParameterDraft) -> Riding {
    let Spec { tolerance, plus, minus, class, .. } = &draft.spec;
    let is_share = |node: &Node| {
        node.scalar().and_then(|scalar| number_and_unit(&scalar.text)).is_some_and(|(_, unit, _)| unit == "%")
    };
    let relative = [plus, minus].map(|side| tolerance.as_ref().or(side.as_ref()).is_some_and(is_share));
    Riding { name: name.to_owned(), is_number: draft.uses.is_empty(), has_class: class.is_some(), relative }
}

fn find_overrides<'o>(
    reader: &mut Reader,
    entries: &[Entry],
    overrides: &'o [(Override, Span)],
) -> HashMap<usize, &'o Override> {
    let mut replaced = HashMap::new();
    for (wanted, span) in overrides {
        match entries.iter().position(|entry| entry.key == wanted.name) {
            Some(index) => {
                replaced.insert(index, wanted);
            }
            // Whether it has one is known later.
            None if dependent::owner(entries, &wanted.name).is_some() => {}
            None => {
                let message = format!("unknown parameter `{}`", suggest::clip(&wanted.name));
                let help = suggest::help(&wanted.name, "parameters", entries.iter().map(|entry| entry.key.as_str()));
                reader.error(Code::UnknownName, span.clone(), message, help);
            }
        }
    }
    replaced
}

/// A parameter's text, with its unit and its formula read.
fn draft(reader: &mut Reader, entry: &Entry, replaced: Option<&Override>) -> ParameterDraft {
    let name_span = entry.key_span.clone();
    let mut spec = Spec::read(reader, entry);
    if let Some(wanted) = replaced.filter(|wanted| notation::fits(reader, &wanted.value, &entry.value)) {
        notation::suspect_unit(reader, &wanted.value, &entry.value);
        spec.replace(reader, &wanted.value);
    }
    if spec.value.is_none() && spec.interval.is_none() && !spec.contradictory {
        reader.error(Code::NoValue, name_span.clone(), "a parameter needs `value` or `interval`", None);
    }
    let unit = spec.unit.as_ref().and_then(|node| unit(reader, node));
    let value = spec.value.as_ref().and_then(|node| reader.written(node));
    if let Some(node) = spec.value.as_ref().filter(|_| value.is_some()) {
        reader.refuse_odd_units(node);
        reader.warn_of_fraction(node);
    }
    spec.check_units(reader);
    let mut uses = Vec::new();
    if let (Some(Written::Formula(formula)), Some(node)) = (&value, &spec.value)
        && reader.check_names(node, formula, 0, Context::Constant)
    {
        uses = formula
            .names()
            .filter_map(|(name, _)| match reader.model.symbol(name) {
                Some(Symbol::Parameter(index)) => Some(index),
                _ => None,
            })
            .collect();
    }
    ParameterDraft { spec, name_span, unit, value, uses, deviation: None }
}

/// A unit by its name.
pub(super) fn unit(reader: &mut Reader, node: &Node) -> Option<Unit> {
    let scalar = reader.scalar(node, "a unit")?;
    match Unit::parse(&scalar.text) {
        Ok(unit) => Some(unit),
        Err(error) => {
            reader.error(Code::UnknownUnit, scalar.place(&node.span, error.span), error.message, error.help);
            None
        }
    }
}

/// Gives the parameter its value, its unit and its dimension; those it uses have theirs.
fn finish(reader: &mut Reader, draft: &ParameterDraft, index: usize, values: &mut [f64]) {
    let (value, mut kind) = match (&draft.value, &draft.spec.value) {
        (Some(written), Some(node)) => match nominal(reader, draft, written, node) {
            Some((formula, kind)) => (Some(formula), kind),
            None => return,
        },
        _ => (None, draft.unit.map_or(KnownDimension::Any, |unit| KnownDimension::parameter(unit.dimension))),
    };
    let at = |name: &str| match reader.model.symbol(name) {
        Some(Symbol::Parameter(used)) => Some(values[used]),
        _ => None,
    };
    let number = value.as_ref().and_then(|formula| evaluate(formula, at));
    if draft.spec.is_uncertain() {
        let nominal = number.filter(|number| number.is_finite());
        if let (Some(formula), Some(deviation)) = (&value, draft.deviation) {
            let own = dependent::Deviating { index, deviation, formula, nominal };
            dependent::finish(reader, draft, own, &mut kind, values);
            return;
        }
        let Some([nominal, lower, upper]) = interval::bounds(reader, draft, nominal, &mut kind) else { return };
        values[index] = nominal;
        reader.model.parameters[index].value = if lower < upper {
            let written = written(reader, draft, &mut kind);
            says_more(reader, draft, index, law::LawInterval { nominal, lower, upper, written }, &mut kind);
            ParameterValue::Interval { nominal, lower, upper }
        } else {
            reader.certain.insert(reader.model.parameters[index].name.clone());
            ParameterValue::Formula(Formula::number(nominal))
        };
    } else if let Some(formula) = value {
        values[index] = number.unwrap_or(f64::NAN);
        reader.model.parameters[index].value = ParameterValue::Formula(formula);
    }
    for (node, key) in [(&draft.spec.distribution, "distribution"), (&draft.spec.cost, "cost")] {
        if let (false, Some(node)) = (draft.spec.is_uncertain(), node) {
            let help = "give it a `tolerance` or an `interval`".to_owned();
            reader.error(
                Code::NotUncertain,
                node.span.clone(),
                format!("the parameter is not uncertain, but has a `{key}`"),
                help,
            );
        }
    }
    settle(reader, draft, index, kind);
}

/// Nominal value and limits as the file has them, where they are numbers that were replaced and a law of them stays.
fn written(reader: &mut Reader, draft: &ParameterDraft, kind: &mut KnownDimension) -> Option<[f64; 3]> {
    let before = draft.spec.before.as_ref()?;
    let value = before.value.as_ref().and_then(|node| reader.written(node));
    let nominal = match (&value, &before.value) {
        (Some(written), Some(node)) => Some(nominal(reader, draft, written, node)?.0.as_number()?),
        _ => None,
    };
    let ParameterDraft { name_span, unit, .. } = draft;
    let mut spec = (**before).clone();
    spec.unit.clone_from(&draft.spec.unit);
    let own =
        ParameterDraft { spec, name_span: name_span.clone(), unit: *unit, value, uses: Vec::new(), deviation: None };
    interval::bounds(reader, &own, nominal, kind)
}

/// Reads the law of an uncertain parameter, and the cost of its tolerance.
fn says_more(
    reader: &mut Reader,
    draft: &ParameterDraft,
    index: usize,
    place: law::LawInterval,
    kind: &mut KnownDimension,
) {
    let name = reader.model.parameters[index].name.clone();
    if let Some(node) = &draft.spec.distribution {
        let law = law::read(reader, draft, node, place, kind);
        reader.model.statistics.asked = true;
        reader.model.statistics.laws.extend(law.map(|law| (name.clone(), law)));
    }
    if let Some(node) = &draft.spec.cost {
        let cost = cost::read(reader, draft, node, place.nominal, kind);
        reader.model.statistics.costs.extend(cost.map(|cost| (name, cost)));
    }
}

/// Notes a parameter's dimension and unit.
fn settle(reader: &mut Reader, draft: &ParameterDraft, index: usize, kind: KnownDimension) {
    reader.kinds[index] = kind;
    if let Some(unit) = written_unit(draft) {
        reader.model.parameter_units.insert(reader.model.parameters[index].name.clone(), unit);
    }
    let declared = draft.unit.filter(|unit| unit.is_si()).and(draft.spec.unit.as_ref()).and_then(Node::scalar);
    reader.model.parameters[index].unit = match (declared, kind) {
        (Some(unit), _) => unit.text.trim().to_owned(),
        (None, KnownDimension::Known { dimension, .. }) => dimension.unit(),
        _ => String::new(),
    };
}

/// The declared unit, or the one after the value; `None` for one of SI.
fn written_unit(draft: &ParameterDraft) -> Option<DisplayUnit> {
    let text = |node: &Option<Node>| Some(node.as_ref()?.scalar()?.text.clone());
    let (unit, text) = match (draft.unit, &draft.value) {
        (Some(unit), _) => (unit, text(&draft.spec.unit)?),
        (None, Some(Written::Quantity { unit, .. })) => {
            (*unit, number_and_unit(&text(&draft.spec.value)?)?.1.to_owned())
        }
        _ => return None,
    };
    (!unit.is_si()).then(|| DisplayUnit::new(&text, unit))
}

/// The value in SI and its dimension.
fn nominal(
    reader: &mut Reader,
    draft: &ParameterDraft,
    written: &Written,
    node: &Node,
) -> Option<(Formula, KnownDimension)> {
    match (written, draft.unit) {
        (Written::Quantity { value, unit }, declared) => {
            if let Some(declared) = declared {
                reader.check_fits(&node.span, unit.dimension, declared.dimension);
            }
            // Users of the parameter rely on the declared dimension.
            let dimension = declared.map_or(unit.dimension, |declared| declared.dimension);
            Some((Formula::number(unit.to_si(*value)), KnownDimension::parameter(dimension)))
        }
        (Written::Formula(formula), Some(unit)) => {
            if let Some(number) = formula.as_number() {
                return Some((Formula::number(unit.to_si(number)), KnownDimension::parameter(unit.dimension)));
            }
            if let Some(found) = reader.kind(node, formula, 0).dimension() {
                reader.check_fits(&node.span, found, unit.dimension);
            }
            if !unit.is_si() {
                let place = draft.spec.unit.as_ref().map_or_else(|| node.span.clone(), |unit| unit.span.clone());
                let help = format!("give the unit as `{}`, or leave it out", unit.dimension.unit());
                reader.error(
                    Code::MissingUnit,
                    place,
                    "a formula gives its value in SI units, so its unit must be one",
                    help,
                );
                return None;
            }
            Some((formula.clone(), KnownDimension::parameter(unit.dimension)))
        }
        (Written::Formula(formula), None) => {
            let kind = reader.kind(node, formula, 0).dimension().map_or(KnownDimension::Any, KnownDimension::parameter);
            Some((formula.clone(), kind))
        }
    }
}

/// Puts parameters, their dimensions and their uses in order.
fn sort(reader: &mut Reader, order: &[usize]) {
    let parameters = std::mem::take(&mut reader.model.parameters);
    let mut slots: Vec<Option<Parameter>> = parameters.into_iter().map(Some).collect();
    reader.model.parameters = order.iter().filter_map(|&index| slots[index].take()).collect();
    reader.kinds = order.iter().map(|&index| reader.kinds[index]).collect();
    reader.used = order.iter().map(|&index| reader.used[index]).collect();
}

/// Warnings of parameters that nothing uses; those that say how often something is repeated are used.
pub fn unused(reader: &Reader, entries: &[Entry], is_count: impl Fn(&str) -> bool) -> Vec<Diagnostic> {
    let used = reader.used.iter().zip(&reader.used_by_parameters).map(|(used, by_parameters)| *used || *by_parameters);
    let used: HashMap<&str, bool> =
        reader.model.parameters.iter().map(|parameter| parameter.name.as_str()).zip(used).collect();
    // Not every deviation of a zone has to act.
    let is_of_zone = |name: &str| reader.model.zones.iter().any(|zone| zone.owns(name));
    let is_idle = |name: &str| used.get(name) == Some(&false) && !is_count(name) && !is_of_zone(name);
    let unused = |entry: &&Entry| is_idle(&entry.key);
    let warning = |entry: &Entry| {
        let message = format!("parameter `{}` is used nowhere", suggest::clip(&entry.key));
        Diagnostic::warning(Code::UnusedParameter, entry.key_span.clone(), message)
    };
    // Numbers of a robot act in its bodies.
    entries.iter().filter(|entry| !is_of_robot(&entry.key)).filter(unused).map(warning).collect()
}

/// Names of the parameters that vary, but that nothing refers to, directly or through others.
pub fn idle(reader: &Reader) -> HashSet<String> {
    let parameters = &reader.model.parameters;
    let positions: HashMap<&str, usize> =
        parameters.iter().enumerate().map(|(index, parameter)| (parameter.name.as_str(), index)).collect();
    let mut needed = reader.used.clone();
    // Each depends on earlier ones only.
    for (index, parameter) in parameters.iter().enumerate().rev() {
        if let (true, ParameterValue::Formula(formula)) = (needed[index], &parameter.value) {
            formula.names().filter_map(|(name, _)| positions.get(name)).for_each(|&used| needed[used] = true);
        }
    }
    let idle = |index: &usize| reader.varies[*index] && !needed[*index];
    (0..parameters.len()).filter(idle).map(|index| parameters[index].name.clone()).collect()
}
