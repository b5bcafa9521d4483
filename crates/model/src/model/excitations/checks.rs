//! Checks of limits against the whole model: whether they cross, keep their rates and hold their mean.

use symdiff::{Binary, Formula};

use super::classes::set_constant;
use super::limits::is_of_time;
use crate::elements::{Class, Excitation, Timing, Trajectory};
use crate::grammar::Symbol;
use crate::grammar::formulas::evaluate;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;

/// Reports limits that cross, that change faster than functions between them may, or that do not hold their mean.
/// Completes classes that depend on the duration.
pub fn check_limits(reader: &mut Reader, fields: &Fields) {
    let duration = reader.model.simulation.duration;
    for own in &mut reader.model.mechanism_mut().trajectories {
        if let Timing::Within(excitation) = &mut own.timing {
            set_constant(&mut excitation.class, duration);
        }
    }
    let Some(node) = fields.get("excitations") else { return };
    for entry in reader.entries(node, "excitations") {
        let found = reader.model.trajectories.iter().find(|own| own.name == entry.key);
        let Some(own) = found.and_then(Trajectory::excitation).cloned() else { continue };
        if let Some((key, message)) = problem(reader, &own) {
            let place = entry.value.get(key).map_or_else(|| entry.key_span.clone(), |node| node.span.clone());
            reader.error(Code::BadExcitation, place, message, None);
        }
    }
}

/// A problem of an excitation: the key at fault, and the message.
fn problem(reader: &Reader, own: &Excitation) -> Option<(&'static str, String)> {
    let first = |formula: &Formula, fails: &dyn Fn(f64) -> bool| first(reader, formula, fails);
    let when = |formula: &Formula, time: f64| {
        if is_of_time(reader, formula) { format!(" at t = {time} s") } else { String::new() }
    };
    if let Some((time, label)) = first(&own.reach, &|reach| reach < 0.0) {
        let when = when(&own.reach, time);
        return Some(("within", format!("the limits cross{when}{label}: the upper one lies below the lower one")));
    }
    match &own.class {
        Class::MovingRate(rate) => {
            [(Binary::Add, "upper"), (Binary::Sub, "lower")].into_iter().find_map(|(side, name)| {
                let limit = own.middle.combined(side, &own.reach);
                let (time, label) = too_fast(reader, &limit, rate)?;
                Some(("within", format!("the {name} limit changes faster than the `rate` at t = {time} s{label}")))
            })
        }
        Class::Mean(mean) => {
            let outside = |value: f64| value.is_nan() || value.abs() > 1.0 + TUNING.rounding_of_limits;
            let (_, label) = mean.iter().find_map(|end| first(end, &outside))?;
            Some(("mean", format!("the mean lies outside of the limits{label}")))
        }
        _ => None,
    }
}

/// Times of the motion at which limits are compared.
fn times(reader: &Reader, count: usize) -> impl Iterator<Item = f64> {
    let duration = reader.model.simulation.duration;
    (0..count).map(move |number| number as f64 / (count.max(2) - 1) as f64 * duration)
}

/// A formula of parameters and t at a corner of the parameters.
fn at(reader: &Reader, formula: &Formula, corner: usize, time: f64) -> Option<f64> {
    evaluate(formula, |name| match reader.symbol(name) {
        Some(Symbol::Parameter(index)) => reader.corners[corner].values.get(index).copied(),
        Some(Symbol::Time) => Some(time),
        _ => None,
    })
}

/// The first time, s, and corner of the parameters at which a formula fails.
fn first(reader: &Reader, formula: &Formula, fails: &dyn Fn(f64) -> bool) -> Option<(f64, String)> {
    let count = if is_of_time(reader, formula) { TUNING.times_of_limits } else { 1 };
    times(reader, count).find_map(|time| {
        let fails = |corner: &usize| at(reader, formula, *corner, time).is_some_and(fails);
        let corner = (0..reader.corners.len()).find(fails)?;
        Some((time, reader.corners[corner].label.clone()))
    })
}

/// The first time, s, and corner at which a limit changes faster than a rate until the next time.
fn too_fast(reader: &Reader, limit: &Formula, rate: &Formula) -> Option<(f64, String)> {
    let times: Vec<f64> = times(reader, TUNING.times_of_limits).collect();
    times.windows(2).find_map(|pair| {
        let fails = |corner: &usize| {
            let [from, to] = [pair[0], pair[1]].map(|time| at(reader, limit, *corner, time));
            let most = at(reader, rate, *corner, 0.0);
            from.zip(to).zip(most).is_some_and(|((from, to), rate)| {
                (to - from).abs() > rate * (pair[1] - pair[0]) * (1.0 + TUNING.rounding_of_limits)
            })
        };
        let corner = (0..reader.corners.len()).find(fails)?;
        Some((pair[0], reader.corners[corner].label.clone()))
    })
}
