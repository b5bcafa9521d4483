//! Whether requirements are fulfilled.

use super::by_rows::by_rows;
use super::ensemble::ReducedEnsemble;
use super::evaluated::Evaluated;
use super::part::MarginPart;
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::methods::Method;
use crate::model::Requirement;
use crate::numerics::{SAFETY_OF_STEPS, Sample, step_error};
use crate::results::{Band, LimitLine, NearestCase, RequirementSummary, Verdict, foremost};
use crate::simulate::SimulationError;
use crate::study::bounding::{Bounded, bands, simulation_error};
use crate::study::problem::Study;

/// NaN is passed on.
fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The verdict of each requirement.
///
/// # Errors
/// If a sample cannot be assembled, and at an interruption.
pub fn verdicts(
    study: &Study,
    values: &Evaluated,
    rows: &Bounded,
    ensembles: [&ReducedEnsemble; 2],
) -> Result<Vec<RequirementSummary>, SimulationError> {
    let requirements = study.description.requirements.iter().enumerate();
    let verdict = |(number, own)| match study.interruption.is_asked() {
        true => Err(SimulationError::Interrupted),
        false => verdict(study, number, own, values, rows, ensembles),
    };
    requirements.map(verdict).collect()
}

fn verdict(
    study: &Study,
    number: usize,
    own: &Requirement,
    values: &Evaluated,
    rows: &Bounded,
    ensembles: [&ReducedEnsemble; 2],
) -> Result<RequirementSummary, SimulationError> {
    let mut parts: Vec<MarginPart> =
        ensembles[0].plan().values.parts(number).map(|index| part(study, values, index)).collect();
    let decided = |parts: &[MarginPart]| parts.iter().all(|part| part.is_known && part.reached() >= 0.0);
    if rows.functions.is_some() {
        parts = by_rows(study, own, rows, f64::INFINITY).map_or(parts, |part| vec![part]);
    } else if !decided(&parts) && !values.unreliable {
        let margin = |(_, all): &(Sample, Vec<f64>)| ensembles[0].plan().values.margin(number, |index| all[index]);
        // NaN stays, and contradicts.
        let simulated = values.samples.iter().map(margin).fold(f64::INFINITY, smaller);
        parts = match by_rows(study, own, rows, simulated) {
            Some(part) if part.reached() >= 0.0 => vec![part],
            _ => parts,
        };
    }
    let lower = parts.iter().map(|part| part.lower).fold(f64::INFINITY, smaller);
    let least = parts.iter().map(MarginPart::reached).fold(f64::INFINITY, smaller);
    let error = lower - least;
    // The part that decides.
    let part = parts.iter().min_by(|a, b| a.reached().total_cmp(&b.reached()));
    let by_functions = rows.functions.is_some() && parts.iter().all(|part| part.is_known) && parts.len() == 1;
    let is_known = parts.iter().all(|part| part.is_known) && (by_functions || !values.unreliable);
    let holds = is_known && least >= 0.0;
    let nearest = nearest(study, number, own, values, holds, ensembles)?;
    let fails = nearest.as_ref().is_some_and(|case| case.margin.is_nan() || case.margin + case.error < 0.0);
    // An end over functions is attained.
    let fails = fails || by_functions && lower + error < 0.0;
    let verdict = match (fails, holds) {
        (true, _) => Verdict::Violated,
        (false, true) => Verdict::Holds,
        (false, false) => Verdict::Undecided,
    };
    let margin = match &nearest {
        Some(case) if lower.is_nan() || case.margin < lower => case.margin,
        _ => lower,
    };
    let limit = own.limits.first().map(|limit| limit.value.abs()).filter(|limit| *limit > 0.0);
    let [surrogate, time] = [part.map(|part| part.surrogate), part.map(|part| part.time)];
    let decides = (verdict == Verdict::Undecided)
        .then(|| decides(own, lower, [surrogate, time].map(|error| error.unwrap_or(f64::NAN)), is_known));
    Ok(RequirementSummary {
        name: own.name.clone(),
        text: own.text.clone(),
        unit: own.unit.clone(),
        display: own.display.clone(),
        verdict,
        certified: verdict == Verdict::Holds && is_certified(own, rows),
        margin,
        percent: limit.map(|limit| 100.0 * margin / limit),
        error,
        surrogate: surrogate.unwrap_or(f64::NAN),
        time: time.unwrap_or(f64::NAN),
        method: part.map_or("nominal", |part| part.method).to_owned(),
        nearest,
        decides,
        limits: limit_lines(study, own),
    })
}

/// Bounds of a part of a margin, by the foremost method: the first that is resolved, or else whose error is to be
/// believed.
fn part(study: &Study, values: &Evaluated, index: usize) -> MarginPart {
    let bands = bands(study, values.bounded, index, 1);
    let is_resolved = |band: &Band| !band.error.unresolved[0];
    let is_known = |band: &Band| band.error.decisive(0).is_some();
    let band = bands.iter().find(|band| is_resolved(band)).or(foremost(&bands, is_known));
    let decisive = band.and_then(|band| band.error.decisive(0));
    MarginPart {
        lower: band.map_or(f64::NAN, |band| band.lower[0]),
        error: band.map_or(f64::NAN, |band| decisive.unwrap_or(band.error.total[0])),
        surrogate: band.map_or(f64::NAN, |band| band.error.surrogate),
        time: band.map_or(f64::NAN, |band| band.error.time),
        is_known: decisive.is_some(),
        method: band.map_or("nominal", |band| band.method.name()),
    }
}

/// The simulated sample with the least margin; if bounds do not show that all hold, the neighbours of the best are
/// tried too.
fn nearest(
    study: &Study,
    number: usize,
    own: &Requirement,
    values: &Evaluated,
    holds: bool,
    [direct, halved]: [&ReducedEnsemble; 2],
) -> Result<Option<NearestCase>, SimulationError> {
    let margin = |all: &[f64]| direct.plan().values.margin(number, |index| all[index]);
    // A missing value fails more than any value.
    let key = |value: f64| if value.is_nan() { f64::NEG_INFINITY } else { value };
    let of_sample = |(sample, all): &(Sample, Vec<f64>)| (sample.clone(), margin(all));
    let best = values.samples.iter().map(of_sample).min_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    let Some(mut best) = best else { return Ok(None) };
    if !holds && best.1 > 0.0 {
        search(study, number, &mut best, direct)?;
    }
    let sample = std::slice::from_ref(&best.0);
    let of = |ensemble: &ReducedEnsemble| {
        let (mut channels, _) = ensemble.channels(sample, true).map_err(simulation_error)?;
        let channels = channels.swap_remove(0);
        let mut all = Vec::new();
        ensemble.plan().values.evaluate(&channels, &sample[0], &mut all);
        Ok::<_, SimulationError>((margin(&all), channels))
    };
    let ((least, channels), (finer, _)) = (of(direct)?, of(halved)?);
    let rounding = own.limits.iter().map(|limit| TUNING.rounding_of_margin * limit.value.abs()).fold(0.0, f64::max);
    let error = SAFETY_OF_STEPS * step_error(&[least], &[finer]) + rounding;
    let xi = study.domain.xi(&best.0);
    let known = study.simulator.system.parameters.iter().zip(best.0.iter());
    Ok(Some(NearestCase {
        parameters: best.0.to_vec(),
        margin: least,
        error: if error.is_nan() && !least.is_nan() { f64::INFINITY } else { error },
        time: direct.plan().when(number, own, &channels),
        corner: !xi.is_empty() && xi.iter().all(|xi| (xi.abs() - 1.0).abs() < 1e-12),
        settings: known.map(|(parameter, value)| setting(&parameter.name, *value, &parameter.unit)).collect(),
        command: String::new(),
    }))
}

/// Looks for a smaller margin around the best sample, along each axis and towards the corners of the box.
fn search(
    study: &Study,
    requirement: usize,
    best: &mut (Sample, f64),
    ensemble: &ReducedEnsemble,
) -> Result<(), SimulationError> {
    let mut reach = TUNING.first_reach;
    for _ in 0..TUNING.rounds_of_search {
        let xi = study.domain.xi(&best.0);
        let mut around: Vec<Vec<f64>> = Vec::new();
        for axis in 0..xi.len() {
            for sign in [-1.0, 1.0] {
                let mut next = xi.clone();
                next[axis] = (next[axis] + sign * reach).clamp(-1.0, 1.0);
                around.push(next);
            }
        }
        let samples = study.domain.samples(&around);
        let (channels, _) = ensemble.channels(&samples, true).map_err(simulation_error)?;
        let mut values = Vec::new();
        let before = best.1;
        for (sample, channels) in samples.iter().zip(&channels) {
            ensemble.plan().values.evaluate(channels, sample, &mut values);
            let margin = ensemble.plan().values.margin(requirement, |index| values[index]);
            if margin < best.1 {
                *best = (sample.clone(), margin);
            }
        }
        if best.1 < 0.0 {
            break;
        }
        if best.1 >= before {
            reach *= 0.5;
        }
    }
    Ok(())
}

/// Whether certified bounds of every slack prove the requirement: in the rows and between them. Bounds of the scheme's
/// motion are of the steps' ends, which are rows only where each row is a step.
fn is_certified(own: &Requirement, rows: &Bounded) -> bool {
    let Some((from, to)) = own.times else { return false };
    let Some((_, outcome)) = rows.methods.iter().find(|(method, _)| *method == Method::Certified) else {
        return false;
    };
    let (schedule, result) = (&rows.plan.schedule, &outcome.result);
    let counts: Vec<usize> = (0..schedule.rows).filter(|&row| (from..=to).contains(&schedule.time(row))).collect();
    if from == to || result.between.is_empty() {
        let seen = schedule.steps_per_row() == Some(1) || from == to;
        let holds = |index: &usize| counts.iter().all(|&row| result.bands[*index][row].lower >= 0.0);
        return seen && !counts.is_empty() && own.outputs.iter().all(holds);
    }
    let overlaps = |row: &usize| schedule.time(*row) >= from && schedule.time(*row - 1) <= to;
    let holds = |index: &usize| (1..schedule.rows).filter(overlaps).all(|row| result.between[*index][row].lower >= 0.0);
    schedule.rows > 1 && own.outputs.iter().all(holds)
}

/// Constant limits of outputs and reduced outputs.
fn limit_lines(study: &Study, own: &Requirement) -> Vec<LimitLine> {
    let end = study.description.simulation.duration;
    let (from, to) = own.times.unwrap_or((0.0, end));
    let is_output = |name: &str| {
        study.description.outputs.iter().any(|output| output.name == name)
            || study.description.reduced.iter().any(|reduced| reduced.name == name)
    };
    let line = |limit: &crate::model::Limit| LimitLine {
        output: limit.of.clone(),
        value: limit.value,
        is_upper: limit.is_upper,
        from,
        to: to.min(end),
    };
    own.limits.iter().filter(|limit| is_output(&limit.of)).map(line).collect()
}

/// Advice on how to decide a requirement.
fn decides(own: &Requirement, lower: f64, [surrogate, time]: [f64; 2], is_known: bool) -> String {
    if !is_known || !(surrogate + time).is_finite() {
        return "reliable bounds: a higher order, shorter steps, or `bounds: { tolerance: … }`".to_owned();
    }
    if lower + surrogate + time < 0.0 {
        return "a sample that fails: the bounds pass the limit, but no simulated sample does; a higher order"
            .to_owned();
    }
    let unit = ShownUnit::of(&own.display, &own.unit);
    let error = format!("{:.1e} {}", unit.of_si(surrogate.max(time)), unit.text);
    match surrogate > time {
        true => format!("a higher order, or a smaller tolerance: the surrogate's error is {}", error.trim_end()),
        false => format!("shorter steps: their error is {}", error.trim_end()),
    }
}

/// `l1=0.15 m`
fn setting(name: &str, value: f64, unit: &str) -> String {
    let number = format!("{value:?}");
    format!("{name}={} {unit}", number.strip_suffix(".0").unwrap_or(&number)).trim_end().to_owned()
}
