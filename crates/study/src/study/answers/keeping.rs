//! The part of a surrogate that a study stores after the run, with the error of its values.

use super::results::Results;
use crate::study::bounding::Outcome;
use crate::study::problem::{Study, problem};
use rayon::prelude::*;

use super::kept::KeptPart;
use crate::methods::{Keep, KeptSurrogate, Method, Refusal};
use crate::numerics::{BandError, PointSet, largest, step_error, surrogate_error};
use crate::simulate::SimulationError;

/// The method whose surrogate is stored.
const METHOD: Method = Method::Chebyshev;

/// Has the surrogate stored, and requests the method that has one.
///
/// # Errors
/// If that method cannot bound the subsystem.
pub fn keep_surrogate(study: &mut Study, keep: Keep) -> Result<(), Refusal> {
    let problem = problem(study.description, &study.simulator);
    study.request.keep = keep;
    study.request.ask(METHOD, &problem);
    study.request.methods_mut().into_iter().try_for_each(|(_, method)| method.fit(&problem))
}

/// Stored surrogate of a run, with the errors of its values in the first `rows` rows; `None` if it is not requested or
/// not known.
pub fn kept(study: &Study, results: &mut Results, rows: usize) -> Option<KeptPart> {
    if !study.request.keep.is_any() {
        return None;
    }
    let times: Vec<f64> = (0..rows).map(|row| results.bounded.plan.schedule.time(row)).collect();
    let (_, outcome) = results.bounded.methods.iter_mut().find(|(method, _)| *method == METHOD)?;
    let surrogate = match outcome.result.kept.take() {
        Some(kept) => kept,
        None if study.domain.dimension() == 0 => {
            let values = |row: usize| outcome.result.bands.iter().map(|ranges| ranges[row].lower).collect();
            KeptSurrogate::constant(times.iter().enumerate().map(|(row, &time)| (time, values(row))))
        }
        // Motions that are cut at events have none.
        None if study.request.keep == Keep::Margins => KeptSurrogate::default(),
        None => return None,
    };
    let rows = rows.min(surrogate.rows()).min(outcome.result.reached);
    let part = KeptPart {
        simulator: study.simulator.clone(),
        surrogate,
        errors: Vec::new(),
        times: times[..rows].to_vec(),
        reduced: results.found.kept.take(),
    };
    let (_, outcome) = results.bounded.methods.iter().find(|(method, _)| *method == METHOD)?;
    let errors = errors_of_values(study, &part, results, outcome).ok()?;
    Some(KeptPart { errors, ..part })
}

/// Errors of values anywhere in the box, by output: the surrogate's, from its deviation at validation samples and the
/// method's own estimate, and those of the time steps.
fn errors_of_values(
    study: &Study,
    part: &KeptPart,
    results: &Results,
    outcome: &Outcome,
) -> Result<Vec<BandError>, SimulationError> {
    let outputs = outcome.result.bands.len();
    let rows = part.times.len();
    let Some((validation, _)) = &results.bounded.validation else { return Ok(vec![BandError::default(); outputs]) };
    let closures = part.closures()?;
    let set = PointSet::of(&study.domain.samples(&validation.points));
    let samples = set.points();
    let every: Vec<usize> = (0..outputs).collect();
    let own: Vec<Vec<f64>> =
        (0..rows).into_par_iter().map(|row| part.surrogate.values(row, &every, samples, &closures)).collect();
    let of_output = |output: usize| {
        let corrections = validation.corrections(output, rows, results.bounded.switched_from());
        let surrogate = |row: usize| {
            let values = &own[row][output * samples.len()..][..samples.len()];
            let found = surrogate_error(values, &validation.direct.at(row, output));
            largest([found, part.surrogate.error(output, row)])
        };
        let time = |row: usize| {
            let halved = validation.halved.at(row, output);
            let damped: f64 = results.bounded.doubts.damped.iter().map(|mode| mode.lost(output, part.times[row])).sum();
            corrections[row].of(step_error(&validation.direct.at(row, output), &halved)) + damped
        };
        let (surrogate, time): (Vec<f64>, Vec<f64>) = (0..rows).map(|row| (surrogate(row), time(row))).unzip();
        let ranges = &outcome.result.bands[output][..rows];
        let mut error = BandError::new(ranges, &surrogate, &time, validation.spans[output], study.request.tolerance);
        if let Some(row) = results.bounded.unreliable_from() {
            error.distrust(row..rows);
        }
        error
    };
    Ok((0..outputs).map(of_output).collect())
}
