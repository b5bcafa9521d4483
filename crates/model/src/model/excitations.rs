//! `excitations:`.

use symdiff::{Binary, Formula, Unary};

use super::names::Reader;
use super::random;
use crate::elements::{Class, Excitation, Timing, Trajectory};
use crate::grammar::dimension::Kind;
use crate::grammar::formulas::evaluate;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::tolerance::{self, Deviation};
use crate::grammar::unit::number_and_unit;
use crate::grammar::{Context, Symbol};
use crate::keys;
use crate::model::description::{Parameter, ParameterValue};
use crate::model::parameters::{deviation_of, seed_of};
use crate::model::tuning::TUNING;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node};

/// Sections whose names formulas may use too.
const OTHERS: [&str; 6] = ["parameters", "bodies", "joints", "effects", "states", "trajectories"];

/// An example of limits.
const EXAMPLE: &str = "e.g. `± 5 N`, `20 N ± 10%`, or `[lower, upper]`";

/// Reads the excitations of a model, after its trajectories.
pub fn read(reader: &mut Reader, fields: &Fields) {
    let Some(node) = fields.get("excitations") else { return };
    for entry in reader.entries(node, "excitations") {
        let named = reader.name(entry, "an excitation");
        let is_taken = |section: &&str| fields.get(section).is_some_and(|section| section.get(&entry.key).is_some());
        if OTHERS.iter().any(is_taken) {
            let message = format!("something else is called `{}` too", clip(&entry.key));
            reader.error(entry.key_span.clone(), message, "give the excitation another name".to_owned());
            continue;
        }
        let Some(found) = excitation(reader, entry).filter(|_| named) else { continue };
        if found.excitation().is_some() {
            add_deviation(reader, &entry.key);
        }
        reader.model.trajectories.push(found);
    }
}

/// Adds the parameter that an excitation is as a constant, which no formula of the file evaluates.
fn add_deviation(reader: &mut Reader, name: &str) {
    let value = ParameterValue::Interval { nominal: 0.0, lower: -1.0, upper: 1.0 };
    let parameter = Parameter { name: deviation_of(name), unit: String::new(), value };
    reader.model.parameters.push(parameter);
    reader.kinds.push(Kind::parameter(Dimension::NUMBER));
    reader.varies.push(true);
    reader.used.push(true);
    reader.used_by_parameters.push(false);
    reader.corners.iter_mut().for_each(|corner| corner.values.push(0.0));
}

/// Middle and half distance of limits.
struct Limits {
    middle: Formula,
    reach: Formula,
}

fn excitation(reader: &mut Reader, entry: &Entry) -> Option<Trajectory> {
    let fields = reader.fields::<keys::Excitation>(&entry.value, entry.key_span.clone())?;
    if random::is_random(&fields) {
        return random::read(reader, entry, &fields);
    }
    let mut dimension = None;
    let limits = match fields.get("within") {
        Some(node) => Some(limits(reader, node, &mut dimension)?),
        None => None,
    };
    let rate = match fields.get("rate") {
        Some(node) => Some(rate(reader, node, &mut dimension)?),
        None => None,
    };
    let held = match fields.get("held") {
        Some(node) => Some(period(reader, node)?),
        None => None,
    };
    let zero = || Formula::number(0.0);
    let (limits, class) = match (limits, rate, held) {
        (_, Some(_), Some(_)) => {
            let help = "leave out `held`, or `rate`".to_owned();
            reader.error(
                fields.key_span("held"),
                "what is constant over periods jumps, and has no limit of its rate",
                help,
            );
            return None;
        }
        (Some(limits), None, None) => (limits, Class::Bounded),
        (Some(limits), None, Some(period)) => (limits, Class::Held(period)),
        (Some(limits), Some(rate), None) => {
            let node = fields.get("within")?;
            refuse_time(reader, node, [&limits.middle, &limits.reach])?;
            let ratio = rate.combined(Binary::Div, &limits.reach);
            (limits, Class::BoundedRate(ratio))
        }
        (None, Some(rate), None) => (Limits { middle: zero(), reach: rate }, Class::Rate),
        (None, None, _) => {
            if !fields.lacks_all(&["within", "rate"]) {
                return None;
            }
            let help =
                "give limits of its value, `within: ± 5 N`, or of its `rate`, or a spectrum, `random`".to_owned();
            reader.error(entry.key_span.clone(), "an excitation needs limits", help);
            return None;
        }
    };
    let Limits { middle, reach } = limits;
    let deviation = Formula::name(&deviation_of(&entry.key));
    let timing = Timing::Within(Box::new(Excitation { deviation, middle, reach, class }));
    Some(Trajectory { name: entry.key.clone(), points: Vec::new(), timing, dimension })
}

/// A formula of t and parameters of the excitation's dimension, or that says it.
fn any_of(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let (formula, own) = reader.any_unit(node, Context::Time)?;
    if let (Some(own), Some(known)) = (own, *dimension) {
        reader.check_fits(&node.span, own, known).then_some(())?;
    }
    *dimension = dimension.or(own);
    Some(formula)
}

fn limits(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Limits> {
    let read = match tolerance::read(node) {
        Ok(read) => read,
        Err(error) => {
            reader.diagnostics.push(*error);
            return None;
        }
    };
    Some(match (read.value, read.deviation) {
        (value, Some(Deviation::Either(deviation))) => around(reader, value.as_ref(), &deviation, dimension)?,
        (None, Some(Deviation::Between(pair))) => {
            let [lower, upper] = reader.two(&pair, "a list of the lower and the upper limit")?;
            let lower = any_of(reader, lower, dimension);
            let upper = any_of(reader, upper, dimension);
            let (lower, upper) = (lower?, upper?);
            let half = Formula::number(0.5);
            Limits {
                middle: lower.combined(Binary::Add, &upper).combined(Binary::Mul, &half),
                reach: upper.combined(Binary::Sub, &lower).combined(Binary::Mul, &half),
            }
        }
        _ => {
            reader.error(node.span.clone(), "limits belong here", EXAMPLE.to_owned());
            return None;
        }
    })
}

/// `20 N ± 10%`, `± 5 N`.
fn around(
    reader: &mut Reader,
    value: Option<&Node>,
    deviation: &Node,
    dimension: &mut Option<Dimension>,
) -> Option<Limits> {
    let middle = match value {
        Some(value) => any_of(reader, value, dimension)?,
        None => Formula::number(0.0),
    };
    let percent = deviation.scalar().and_then(|scalar| number_and_unit(&scalar.text));
    let reach = match (percent.filter(|(_, unit, _)| *unit == "%"), value) {
        (Some((percent, ..)), Some(_)) => {
            middle.clone().applied(Unary::Abs).combined(Binary::Mul, &Formula::number(percent / 100.0))
        }
        _ => any_of(reader, deviation, dimension)?,
    };
    Some(Limits { middle, reach })
}

/// Reports limits of which the upper one lies below the lower one, at some time and parameters.
pub fn check_limits(reader: &mut Reader, fields: &Fields) {
    let Some(node) = fields.get("excitations") else { return };
    for entry in reader.entries(node, "excitations") {
        let found = reader.model.trajectories.iter().find(|own| own.name == entry.key);
        let Some(reach) = found.and_then(Trajectory::excitation).map(|own| own.reach.clone()) else { continue };
        let Some((time, label)) = crossing(reader, &reach) else { continue };
        let when = if is_of_time(reader, &reach) { format!(" at t = {time} s") } else { String::new() };
        let message = format!("the limits cross{when}{label}: the upper one lies below the lower one");
        let place = entry.value.get("within").map_or_else(|| entry.key_span.clone(), |node| node.span.clone());
        reader.error(place, message, None);
    }
}

/// The first time, s, and corner of the parameters at which half of the distance of limits is negative.
fn crossing(reader: &Reader, reach: &Formula) -> Option<(f64, String)> {
    let count = if is_of_time(reader, reach) { TUNING.times_of_limits } else { 1 };
    let times = (0..count).map(|number| number as f64 / (count.max(2) - 1) as f64 * reader.model.simulation.duration);
    times.into_iter().find_map(|time| {
        let corner = reader.corners.iter().find(|corner| {
            let value = evaluate(reach, |name| match reader.symbol(name) {
                Some(Symbol::Parameter(index)) => corner.values.get(index).copied(),
                Some(Symbol::Time) => Some(time),
                _ => None,
            });
            value.is_some_and(|value| value < 0.0)
        })?;
        Some((time, corner.label.clone()))
    })
}

/// Whether a formula changes in time.
fn is_of_time(reader: &Reader, formula: &Formula) -> bool {
    formula.names().any(|(name, _)| matches!(reader.symbol(name), Some(Symbol::Time | Symbol::Trajectory { .. })))
}

/// The limit of the rate: a formula of parameters.
fn rate(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let mut of_rate = dimension.map(|dimension| dimension.per(Dimension::TIME));
    let (formula, own) = reader.any_unit(node, Context::Constant)?;
    if let (Some(own), Some(known)) = (own, of_rate) {
        reader.check_fits(&node.span, own, known).then_some(())?;
    }
    of_rate = of_rate.or(own);
    *dimension = dimension.or(of_rate.map(|rate| rate.times(Dimension::TIME)));
    reader.require(node, &formula, |rate| rate > 0.0, "must be positive");
    Some(formula)
}

/// A period, s.
fn period(reader: &mut Reader, node: &Node) -> Option<f64> {
    let formula =
        reader.formula_that(node, Context::Constant, Dimension::TIME, |held| held > 0.0, "must be positive")?;
    if reader.is_uncertain(&formula) {
        reader.error(node.span.clone(), "a period is the same for all samples", None);
        return None;
    }
    reader.evaluate(&formula, 0).filter(|period| period.is_finite() && *period > 0.0)
}

/// Limits of functions with a limited rate do not move themselves.
fn refuse_time(reader: &mut Reader, node: &Node, formulas: [&Formula; 2]) -> Option<()> {
    if !formulas.into_iter().any(|formula| is_of_time(reader, formula)) {
        return Some(());
    }
    let message = "with a `rate`, limits do not change in time";
    reader.error(node.span.clone(), message, "add what changes to the formulas that use it".to_owned());
    None
}

/// Reports joints that an excitation would drive: they need its acceleration, which is not known.
pub fn check_joints(reader: &mut Reader, entries: &[Entry]) {
    let names_one = |formula: &Formula| {
        formula.names().find_map(|(name, _)| match reader.symbol(name) {
            Some(Symbol::Trajectory { trajectory, .. }) => {
                let trajectory = &reader.model.trajectories[trajectory];
                trajectory.excitation().map(|_| trajectory.name.clone())
            }
            _ => None,
        })
    };
    let mut found = Vec::new();
    for joint in &reader.model.joints {
        let excitation = joint.kind.formulas().into_iter().find_map(names_one);
        let entry = entries.iter().find(|entry| entry.key == joint.name);
        found.extend(excitation.zip(entry).map(|(excitation, entry)| (entry.key_span.clone(), excitation)));
    }
    for (index, excitation) in found {
        let message =
            format!("a joint cannot follow the excitation `{}`: its acceleration is not known", clip(&excitation));
        reader.error(index, message, "let a force follow it, or a `servo`".to_owned());
    }
}

/// Leaves out the parameters of excitations that nothing uses, and warns of these.
pub fn unused(reader: &mut Reader, fields: &Fields) -> Vec<Diagnostic> {
    let Some(node) = fields.get("excitations") else { return Vec::new() };
    let mut warnings = Vec::new();
    for entry in reader.entries(node, "excitations") {
        let index = reader.model.trajectories.iter().position(|own| own.name == entry.key);
        let Some(index) = index.filter(|index| !reader.used_trajectories.contains(index)) else { continue };
        match &reader.model.trajectories[index].timing {
            Timing::Within(_) => reader.idle.insert(deviation_of(&entry.key)),
            Timing::Random(_) => reader.idle.insert(seed_of(&entry.key)),
            _ => continue,
        };
        let message = format!("excitation `{}` is used nowhere", clip(&entry.key));
        warnings.push(Diagnostic::warning(entry.key_span.clone(), message));
    }
    warnings
}
