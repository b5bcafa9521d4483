//! `parameters:` and the `--set` that replace them.

use crate::grammar::Referent;
use std::collections::{HashMap, HashSet};

use symdiff::Formula;

use super::description::{Parameter, ParameterValue};
use super::file;
use super::overrides::Override;
use super::urdf;
use crate::grammar::dimension::Kind;
use crate::grammar::names::Context;
use crate::grammar::quantity::{Unit, number_and_unit};
use crate::grammar::reader::{Corner, Written, evaluate};
use crate::model::names::Reader;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest;
use crate::syntax::yaml::{Entry, Node};

/// Uncertain parameters up to which every corner is checked; beyond, one parameter at a time.
const MOST_FOR_CORNERS: usize = 5;

/// Most parameters: every name of a formula is looked for among them.
const MOST: usize = 20_000;

/// Most uncertain ones: every formula is checked at the ends of each.
const MOST_UNCERTAIN: usize = 1000;

/// A parameter as it was written.
#[derive(Default)]
struct Spec<'n> {
    value: Option<&'n Node>,
    unit: Option<&'n Node>,
    tolerance: Option<&'n Node>,
    interval: Option<&'n Node>,
    plus: Option<&'n Node>,
    minus: Option<&'n Node>,
}

/// A parameter between its text and its value.
struct Draft<'n> {
    spec: Spec<'n>,
    name_span: Span,
    unit: Option<Unit>,
    value: Option<Written>,
    /// Parameters that the value's formula names.
    uses: Vec<usize>,
}

impl Spec<'_> {
    fn is_uncertain(&self) -> bool {
        self.tolerance.is_some() || self.interval.is_some() || self.plus.is_some() || self.minus.is_some()
    }
}

/// Reads the parameters; after this, formulas of them can be checked and evaluated.
pub fn read(reader: &mut Reader, entries: &[Entry], overrides: &[(Override, Span)]) {
    let mut entries = entries;
    let mut own = entries.iter().enumerate().filter(|(_, entry)| !urdf::is_number(&entry.key));
    if let Some((first, entry)) = own.nth(MOST) {
        reader.error(entry.key_span.clone(), format!("the model has more than {MOST} parameters"), None);
        entries = &entries[..first];
    }
    let replaced = find_overrides(reader, entries, overrides);
    for entry in entries {
        if !urdf::is_number(&entry.key) {
            reader.name(entry, "a parameter");
        }
        // Not a number until it is known: no file can write that.
        let value = ParameterValue::Formula(Formula::number(f64::NAN));
        reader.model.parameters.push(Parameter { name: entry.key.clone(), unit: String::new(), value });
    }
    reader.used = vec![false; entries.len()];
    reader.kinds = vec![Kind::Any; entries.len()];
    let drafts: Vec<Draft> =
        entries.iter().enumerate().map(|(index, entry)| draft(reader, entry, replaced.get(&index).copied())).collect();
    let order = in_order(reader, &drafts);
    let mut values = vec![f64::NAN; entries.len()];
    for &index in &order {
        finish(reader, &drafts[index], index, &mut values);
    }
    sort(reader, &order);
    let places: Vec<Span> = order.iter().map(|&index| drafts[index].name_span.clone()).collect();
    corners(reader, &places);
    let none = vec![false; entries.len()];
    reader.used_by_parameters = std::mem::replace(&mut reader.used, none);
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
            None => {
                let message = format!("unknown parameter `{}`", suggest::clip(&wanted.name));
                let help = suggest::help(&wanted.name, "parameters", entries.iter().map(|entry| entry.key.as_str()));
                reader.error(span.clone(), message, help);
            }
        }
    }
    replaced
}

/// What was written, its unit and its formula read.
fn draft<'n>(reader: &mut Reader, entry: &'n Entry, replaced: Option<&'n Override>) -> Draft<'n> {
    let name_span = entry.key_span.clone();
    let mut spec = Spec::default();
    if matches!(entry.value.value, crate::syntax::yaml::Value::Mapping(_)) {
        if let Some(fields) = reader.fields::<file::Parameter>(&entry.value, name_span.clone()) {
            spec = Spec {
                value: fields.get("value"),
                unit: fields.get("unit"),
                tolerance: fields.get("tolerance"),
                interval: fields.get("interval"),
                plus: fields.get("plus"),
                minus: fields.get("minus"),
            };
            if let Some(description) = fields.get("description") {
                reader.scalar(description, "a text");
            }
            if spec.value.is_none() && spec.interval.is_none() {
                reader.error(name_span.clone(), "a parameter needs `value` or `interval`", None);
            }
        }
    } else {
        spec.value = Some(&entry.value);
    }
    if let Some(wanted) = replaced {
        spec = Spec {
            value: wanted.value.as_ref(),
            tolerance: wanted.tolerance.as_ref(),
            interval: wanted.interval.as_ref(),
            unit: spec.unit,
            ..Spec::default()
        };
    }
    let unit = spec.unit.and_then(|node| unit(reader, node));
    let value = spec.value.and_then(|node| reader.written(node));
    let mut uses = Vec::new();
    if let (Some(Written::Formula(formula)), Some(node)) = (&value, spec.value)
        && reader.check_names(node, formula, 0, Context::Constant)
    {
        uses = formula
            .names()
            .filter_map(|(name, _)| match reader.model.referent(name) {
                Some(Referent::Parameter(index)) => Some(index),
                _ => None,
            })
            .collect();
    }
    Draft { spec, name_span, unit, value, uses }
}

/// A unit by its name.
pub(super) fn unit(reader: &mut Reader, node: &Node) -> Option<Unit> {
    let scalar = reader.scalar(node, "a unit")?;
    match Unit::parse(&scalar.text) {
        Ok(unit) => Some(unit),
        Err(error) => {
            reader.error(scalar.place(&node.span, error.span), error.message, error.help);
            None
        }
    }
}

/// An order in which every parameter stands behind those it uses: the file's, where that is one. Circles are
/// reported, and broken where they close.
fn in_order(reader: &mut Reader, drafts: &[Draft]) -> Vec<usize> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let mut marks = vec![Mark::New; drafts.len()];
    let mut order = Vec::with_capacity(drafts.len());
    // Uncertain parameters keep the file's order among themselves, whatever uses them.
    let in_file_order = drafts.iter().enumerate().all(|(index, draft)| draft.uses.iter().all(|&used| used < index));
    let (mut roots, rest): (Vec<usize>, Vec<usize>) =
        (0..drafts.len()).partition(|&index| in_file_order || drafts[index].spec.is_uncertain());
    roots.extend(rest);
    for root in roots {
        let mut path: Vec<(usize, usize)> = vec![(root, 0)];
        if marks[root] != Mark::New {
            continue;
        }
        marks[root] = Mark::Open;
        while let Some((index, next)) = path.last_mut() {
            let index = *index;
            match drafts[index].uses.get(*next) {
                None => {
                    marks[index] = Mark::Done;
                    order.push(index);
                    path.pop();
                }
                Some(&used) => {
                    *next += 1;
                    match marks[used] {
                        Mark::New => {
                            marks[used] = Mark::Open;
                            path.push((used, 0));
                        }
                        Mark::Open => {
                            let start = path.iter().position(|(index, _)| *index == used).unwrap_or(0);
                            let circle: Vec<usize> = path[start..].iter().map(|(index, _)| *index).collect();
                            report_circle(reader, drafts, &circle);
                        }
                        Mark::Done => {}
                    }
                }
            }
        }
    }
    order
}

fn report_circle(reader: &mut Reader, drafts: &[Draft], circle: &[usize]) {
    let name = |index: usize| suggest::clip(&reader.model.parameters[index].name);
    let shown: Vec<String> = circle.iter().take(8).map(|&index| name(index)).collect();
    let more = if circle.len() > 8 { " → …" } else { "" };
    let message = format!("parameters depend on each other in a circle: {}{more} → {}", shown.join(" → "), shown[0]);
    let mut diagnostic = Diagnostic::error(drafts[circle[0]].name_span.clone(), message);
    for &index in circle.iter().skip(1).take(3) {
        diagnostic = diagnostic.also(drafts[index].name_span.clone(), "also in it");
    }
    reader.diagnostics.push(diagnostic);
}

/// Gives the parameter its value, its unit and its dimension; those it uses have theirs.
fn finish(reader: &mut Reader, draft: &Draft, index: usize, values: &mut [f64]) {
    let (value, mut kind) = match (&draft.value, draft.spec.value) {
        (Some(written), Some(node)) => match nominal(reader, draft, written, node) {
            Some((formula, kind)) => (Some(formula), kind),
            None => return,
        },
        _ => (None, draft.unit.map_or(Kind::Any, |unit| Kind::parameter(unit.dimension))),
    };
    let at = |name: &str| match reader.model.referent(name) {
        Some(Referent::Parameter(used)) => Some(values[used]),
        _ => None,
    };
    let number = value.as_ref().and_then(|formula| evaluate(formula, at));
    if draft.spec.is_uncertain() {
        let nominal = number.filter(|number| number.is_finite());
        if let (Some(node), true) = (draft.spec.value, depends_on_uncertain(reader, draft)) {
            let message = "the value of an uncertain parameter cannot depend on an uncertain parameter";
            let help = "leave the tolerance out: what depends on an uncertain parameter varies with it".to_owned();
            reader.error(node.span.clone(), message, help);
        }
        let Some([nominal, lower, upper]) = bounds(reader, draft, nominal, &mut kind) else { return };
        values[index] = nominal;
        reader.model.parameters[index].value = ParameterValue::Interval { nominal, lower, upper };
    } else if let Some(formula) = value {
        values[index] = number.unwrap_or(f64::NAN);
        reader.model.parameters[index].value = ParameterValue::Formula(formula);
    }
    reader.kinds[index] = kind;
    let declared = draft.unit.filter(|unit| unit.is_si()).and(draft.spec.unit).and_then(Node::scalar);
    reader.model.parameters[index].unit = match (declared, kind) {
        (Some(unit), _) => unit.text.trim().to_owned(),
        (None, Kind::Known { dimension, .. }) => dimension.unit(),
        _ => String::new(),
    };
}

/// The value in SI and its dimension.
fn nominal(reader: &mut Reader, draft: &Draft, written: &Written, node: &Node) -> Option<(Formula, Kind)> {
    match (written, draft.unit) {
        (Written::Quantity { value, unit }, declared) => {
            if let Some(declared) = declared {
                reader.check_fits(&node.span, unit.dimension, declared.dimension);
            }
            // The declared one is what users of the parameter count on.
            let dimension = declared.map_or(unit.dimension, |declared| declared.dimension);
            Some((Formula::number(unit.to_si(*value)), Kind::parameter(dimension)))
        }
        (Written::Formula(formula), Some(unit)) => {
            if let Some(number) = formula.as_number() {
                return Some((Formula::number(unit.to_si(number)), Kind::parameter(unit.dimension)));
            }
            if let Some(found) = reader.kind(node, formula, 0).dimension() {
                reader.check_fits(&node.span, found, unit.dimension);
            }
            if !unit.is_si() {
                let place = draft.spec.unit.map_or_else(|| node.span.clone(), |unit| unit.span.clone());
                let help = format!("give the unit as `{}`, or leave it out", unit.dimension.unit());
                reader.error(place, "a formula gives its value in SI units, so its unit must be one", help);
                return None;
            }
            Some((formula.clone(), Kind::parameter(unit.dimension)))
        }
        (Written::Formula(formula), None) => {
            let kind = reader.kind(node, formula, 0).dimension().map_or(Kind::Any, Kind::parameter);
            Some((formula.clone(), kind))
        }
    }
}

fn depends_on_uncertain(reader: &Reader, draft: &Draft) -> bool {
    // Whether a formula of others varies is known only in order: follow what they use.
    let mut open: Vec<usize> = draft.uses.clone();
    let mut seen = vec![false; reader.model.parameters.len()];
    while let Some(index) = open.pop() {
        if std::mem::replace(&mut seen[index], true) {
            continue;
        }
        match &reader.model.parameters[index].value {
            ParameterValue::Interval { .. } => return true,
            ParameterValue::Formula(formula) => {
                open.extend(formula.names().filter_map(|(name, _)| match reader.model.referent(name) {
                    Some(Referent::Parameter(used)) => Some(used),
                    _ => None,
                }));
            }
        }
    }
    false
}

/// Nominal, lower and upper value.
fn bounds(reader: &mut Reader, draft: &Draft, nominal: Option<f64>, kind: &mut Kind) -> Option<[f64; 3]> {
    let Spec { value, tolerance, interval, plus, minus, .. } = &draft.spec;
    let ways = [*tolerance, *interval, plus.or(*minus)];
    if let Some(second) = ways.iter().flatten().nth(1) {
        let help = "give one of them".to_owned();
        let message = "`tolerance`, `interval` and `plus`/`minus` say the same thing";
        reader.error(second.span.clone(), message, help);
        return None;
    }
    if let Some(node) = interval {
        let [first, second] = reader.two(node, "a list of the smallest and the largest value")?;
        let lower = bare_number(reader, draft, first, kind);
        let upper = bare_number(reader, draft, second, kind);
        let (lower, upper) = (lower?, upper?);
        if lower > upper {
            let help = format!("the smaller one stands first: `[{}, {}]`", text(second), text(first));
            reader.error(node.span.clone(), "the interval is reversed", help);
            return None;
        }
        let nominal = match (value, nominal) {
            (None, _) => lower + (upper - lower) / 2.0,
            (Some(_), nominal) => nominal?,
        };
        if !(lower..=upper).contains(&nominal) {
            let place = value.map_or_else(|| node.span.clone(), |value| value.span.clone());
            let diagnostic = Diagnostic::error(place, "the value lies outside its interval");
            reader.diagnostics.push(diagnostic.also(node.span.clone(), "the interval"));
            return None;
        }
        return Some([nominal, lower, upper]);
    }
    // Without a value there is nothing to deviate from; that was reported.
    value.as_ref()?;
    let (above, below) = match tolerance {
        Some(node) => {
            let either = deviation(reader, draft, Some(node), nominal, kind);
            (either, either)
        }
        None => (deviation(reader, draft, *plus, nominal, kind), deviation(reader, draft, *minus, nominal, kind)),
    };
    let (nominal, above, below) = (nominal?, above?, below?);
    Some([nominal, nominal - below, nominal + above])
}

/// How far a value may deviate: `1%` of it, or a quantity.
fn deviation(
    reader: &mut Reader,
    draft: &Draft,
    node: Option<&Node>,
    nominal: Option<f64>,
    kind: &mut Kind,
) -> Option<f64> {
    let Some(node) = node else { return Some(0.0) };
    let percent = node.scalar().and_then(|scalar| number_and_unit(&scalar.text)).filter(|(_, unit, _)| *unit == "%");
    let deviation = match percent {
        Some((percent, ..)) => {
            // The sign of the percentage, not of the value, says whether it is negative.
            percent / 100.0 * nominal?.abs()
        }
        None => bare_number(reader, draft, node, kind)?,
    };
    let negative = percent.map_or(deviation, |(percent, ..)| percent) < 0.0;
    if negative {
        reader.error(node.span.clone(), "a tolerance cannot be negative", None);
        return None;
    }
    Some(deviation)
}

/// A number in the parameter's unit, or with its own.
fn bare_number(reader: &mut Reader, draft: &Draft, node: &Node, kind: &mut Kind) -> Option<f64> {
    match reader.written(node)? {
        Written::Quantity { value, unit } => {
            match kind.dimension() {
                Some(dimension) => {
                    reader.check_fits(&node.span, unit.dimension, dimension).then_some(())?;
                }
                None => *kind = Kind::parameter(unit.dimension),
            }
            Some(unit.to_si(value))
        }
        Written::Formula(formula) => {
            if !reader.check_names(node, &formula, 0, Context::Constant) {
                return None;
            }
            if formula.names().next().is_some() {
                reader.error(node.span.clone(), "the limits of a parameter are numbers, not formulas", None);
                return None;
            }
            let own_unit = matches!(draft.value, Some(Written::Quantity { .. })) && draft.unit.is_none();
            if own_unit {
                let unit = draft.spec.value.and_then(Node::scalar).and_then(|scalar| number_and_unit(&scalar.text));
                let help = format!("e.g. `{} {}`", text(node), unit.map_or("m", |(_, unit, _)| unit));
                reader.error(node.span.clone(), "this number has no unit, but the value has", help);
                return None;
            }
            let number = evaluate(&formula, |_| None).filter(|number| number.is_finite());
            if number.is_none() {
                reader.error(node.span.clone(), format!("`{}` is not a finite number", text(node)), None);
            }
            Some(draft.unit.map_or(number?, |unit| unit.to_si(number.unwrap_or(f64::NAN))))
        }
    }
}

fn text(node: &Node) -> String {
    suggest::clip(node.scalar().map_or("", |scalar| scalar.text.trim()))
}

/// Puts parameters, their dimensions and their uses in order.
fn sort(reader: &mut Reader, order: &[usize]) {
    let parameters = std::mem::take(&mut reader.model.parameters);
    let mut slots: Vec<Option<Parameter>> = parameters.into_iter().map(Some).collect();
    reader.model.parameters = order.iter().filter_map(|&index| slots[index].take()).collect();
    reader.kinds = order.iter().map(|&index| reader.kinds[index]).collect();
    reader.used = order.iter().map(|&index| reader.used[index]).collect();
}

/// Evaluates all parameters at the nominal values and at the corners of the intervals.
fn corners(reader: &mut Reader, name_spans: &[Span]) {
    let parameters = &reader.model.parameters;
    let uncertain: Vec<(usize, f64, f64)> = parameters
        .iter()
        .enumerate()
        .filter_map(|(index, parameter)| match parameter.value {
            ParameterValue::Interval { lower, upper, .. } => Some((index, lower, upper)),
            ParameterValue::Formula(_) => None,
        })
        .collect();
    let mut choices: Vec<Vec<(usize, f64)>> = vec![Vec::new()];
    let beyond = uncertain.get(MOST_UNCERTAIN).map(|&(index, ..)| index);
    if beyond.is_some() {
        // That is an error: nothing else has to be found at so many corners.
    } else if uncertain.len() <= MOST_FOR_CORNERS {
        choices.extend((0..1_usize << uncertain.len()).filter(|_| !uncertain.is_empty()).map(|corner| {
            let end = |(bit, &(index, lower, upper)): (usize, &(usize, f64, f64))| {
                (index, if corner >> bit & 1 == 0 { lower } else { upper })
            };
            uncertain.iter().enumerate().map(end).collect()
        }));
    } else {
        choices
            .extend(uncertain.iter().flat_map(|&(index, lower, upper)| [vec![(index, lower)], vec![(index, upper)]]));
    }
    let positions: HashMap<&str, usize> =
        parameters.iter().enumerate().map(|(index, parameter)| (parameter.name.as_str(), index)).collect();
    let varies = parameters.iter().fold(Vec::new(), |mut varies: Vec<bool>, parameter| {
        varies.push(match &parameter.value {
            ParameterValue::Interval { .. } => true,
            ParameterValue::Formula(formula) => formula
                .names()
                .any(|(name, _)| positions.get(name).is_some_and(|&index| varies.get(index).copied().unwrap_or(false))),
        });
        varies
    });
    let mut corners: Vec<Corner> = Vec::new();
    for chosen in choices {
        let mut values: Vec<f64> = Vec::with_capacity(parameters.len());
        for (index, parameter) in parameters.iter().enumerate() {
            let value = match &parameter.value {
                ParameterValue::Interval { nominal, .. } => {
                    chosen.iter().find(|(chosen, _)| *chosen == index).map_or(*nominal, |(_, value)| *value)
                }
                ParameterValue::Formula(_) if !varies[index] && !corners.is_empty() => corners[0].values[index],
                ParameterValue::Formula(formula) => {
                    evaluate(formula, |name| positions.get(name).and_then(|&used| values.get(used).copied()))
                        .unwrap_or(f64::NAN)
                }
            };
            values.push(value);
        }
        let place: Vec<String> =
            chosen.iter().map(|(index, value)| format!("{} = {value}", parameters[*index].name)).collect();
        let label = if place.is_empty() { String::new() } else { format!(" at {}", place.join(", ")) };
        corners.push(Corner { values, label });
    }
    let infinite: Vec<(usize, String)> = (0..parameters.len())
        .filter_map(|index| {
            let corner = corners.iter().find(|corner| !corner.values[index].is_finite())?;
            // What uses a parameter without a value has none either: the first is to blame.
            let blames_another = match &parameters[index].value {
                ParameterValue::Formula(formula) if formula.as_number().is_some_and(f64::is_nan) => true,
                ParameterValue::Formula(formula) => formula.names().any(|(name, _)| {
                    positions.get(name).is_none_or(|&used| used >= index || !corner.values[used].is_finite())
                }),
                ParameterValue::Interval { .. } => true,
            };
            (!blames_another).then(|| (index, corner.label.clone()))
        })
        .collect();
    if let Some(index) = beyond {
        let message = format!("the model has more than {MOST_UNCERTAIN} uncertain parameters");
        reader.error(name_spans[index].clone(), message, None);
    }
    for (index, label) in infinite {
        let message = format!("`{}` is not a finite number{label}", reader.model.parameters[index].name);
        reader.error(name_spans[index].clone(), message, None);
    }
    reader.broken = corners.iter().any(|corner| corner.values.iter().any(|value| !value.is_finite()));
    reader.corners = corners;
    reader.varies = varies;
}

/// Warnings of parameters that nothing uses.
pub fn unused(reader: &Reader, entries: &[Entry]) -> Vec<Diagnostic> {
    let used = reader.used.iter().zip(&reader.used_by_parameters).map(|(used, by_parameters)| *used || *by_parameters);
    let used: HashMap<&str, bool> =
        reader.model.parameters.iter().map(|parameter| parameter.name.as_str()).zip(used).collect();
    let unused = |entry: &&Entry| used.get(entry.key.as_str()) == Some(&false);
    let warning = |entry: &Entry| {
        let message = format!("parameter `{}` is used nowhere", suggest::clip(&entry.key));
        Diagnostic::warning(entry.key_span.clone(), message)
    };
    // What a robot's numbers do is in its bodies.
    entries.iter().filter(|entry| !urdf::is_number(&entry.key)).filter(unused).map(warning).collect()
}

/// Names of the parameters that vary, but that nothing speaks of, directly or through others.
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
