//! One subsystem's study: the step schedule that all samples share, and the methods under it.

use super::RunError;
use super::answers::{Ran, Results, conclude};
use super::attained;
use super::bounding::{Bounded, Doubts, bound, note_nominal, timed, unknown};
use super::deterministic::deterministic;
use super::ensemble::{Progress, nominal};
use super::internal::{InternalError, caught};
use super::price::total_work;
use super::problem::Study;
use super::reduced::{Found, plan_reduction, reduced};
use super::stepping::{
    balance, controlling_samples, damped_modes, divided, explicit_samples, explicit_within, integration,
    may_be_explicit, refused, schedule_within, segmented, switches, validation,
};
use crate::methods::{Method, Observed, Validation};
use crate::model::Stepping;
use crate::numerics::{Ledger, Sample};
use crate::simulate::{Controller, Divided, Schedule, SimulationError, Steps, schedule_for_tolerance};

/// Progress of a box's validation samples.
pub(super) struct Tried {
    /// Rows that all have reached.
    pub reached: usize,
    /// ξ of those that did not reach the end.
    pub stopped: Vec<Vec<f64>>,
    /// Whether any did.
    pub any: bool,
}

/// Runs every method.
pub(super) fn run(study: &Study) -> Result<Ran, RunError> {
    if let Some(schedule) = segmented(study)? {
        return Ok(conclude(study, methods(study, &schedule, None)?, None));
    }
    let simulation = &study.description.simulation;
    match simulation.stepping {
        Stepping::Fixed(step) => {
            let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
            let results = methods(study, &schedule.taken(integration(study)), None)?;
            Ok(conclude(study, results, None))
        }
        Stepping::Tolerance(tolerance) => Ok(run_controlled(study, tolerance)?),
    }
}

/// The schedule of the controlling samples serves all; a sample that needs shorter steps in between takes its own.
fn run_controlled(study: &Study, tolerance: f64) -> Result<Ran, SimulationError> {
    (study.stage)("choosing the steps");
    let samples = controlling_samples(study);
    if may_be_explicit(study) && study.request.tolerance.is_none_or(|bounds| tolerance < bounds) {
        match explicit_within(study, tolerance, &explicit_samples(study))? {
            Ok(schedule) => return Ok(conclude(study, methods(study, &schedule, None)?, None)),
            Err(obstacle) => refused(study, obstacle)?,
        }
    }
    let (controlled, controller) = schedule_within(study, tolerance, &samples)?;
    let failure = controlled.failure.map(|failure| format!("{failure}; what does not need that sample is kept"));
    let results = methods(study, &controlled.schedule, Some(controller))?;
    Ok(conclude(study, results, failure))
}

/// The nominal motion, the validation samples, then every method asked for. With a tolerance for the bounds, the
/// validation samples decide how the schedule's steps are divided or joined.
fn methods(study: &Study, schedule: &Schedule, mut tolerance: Option<Controller>) -> Result<Results, SimulationError> {
    plan_reduction(study, schedule, tolerance)?;
    if study.domain.dimension() == 0 {
        return deterministic(study, schedule, tolerance);
    }
    let progress = Progress::new(total_work(study, schedule), study.progress);
    let mut internal = Vec::new();
    let (Divided { schedule, unresolved_from }, validation) = if study.request.is_empty() {
        (divided(study, schedule.clone()), None)
    } else {
        match caught("the validation samples", || balance(study, schedule, tolerance, &progress)) {
            Ok(balanced) => {
                let (schedule, divided, validation) = balanced?;
                tolerance = divided;
                (schedule, Some(validation))
            }
            Err(error) => {
                internal.push(error);
                (divided(study, schedule.clone()), None)
            }
        }
    };
    let switches = match &validation {
        Some((validation, _)) => {
            switches(study, Steps { schedule: &schedule, controller: tolerance }, validation, &mut internal)?
        }
        None => None,
    };
    let seen = Ledger::new(schedule.rows, study.simulator.program.outputs.len());
    let motions = study.motions(&schedule, tolerance, &progress).noting(&seen);
    (study.stage)("nominal motion");
    let (nominal, singular) = timed(&schedule, "nominal", || nominal(&motions))?;
    note_nominal(study, &nominal.result, &seen);
    let (mut methods, mut halved, mut attained) = (Vec::new(), Vec::new(), None);
    if let Some((validation, _)) = &validation {
        validation.note(&seen);
        methods = bound(study, &motions, &schedule, validation, &mut internal, |_| true)?;
        attained = attained::attained(study, &motions, &schedule)?;
        if study.certify_time && !study.interruption.is_asked() {
            let schedule = schedule.refined(2);
            let halved_tolerance = tolerance.map(|tolerance| tolerance.for_parts(2));
            let motions = study.motions(&schedule, halved_tolerance, &progress);
            let sampled = |method: Method| method.about().is_sampled;
            halved = bound(study, &motions, &schedule, validation, &mut internal, sampled)?;
        }
    }
    drop(motions);
    let damped = damped_modes(study, &schedule);
    let doubts = Doubts { unresolved_from, switches, damped };
    let bounded = Bounded { validation, methods, halved, ..Bounded::new(schedule, nominal, seen, doubts) };
    let found = match study.interruption.is_asked() {
        true => Found::default(),
        false => match reduced(study, &bounded, tolerance, &progress) {
            Err(SimulationError::Interrupted) => Found::nothing(study.description),
            found => found?,
        },
    };
    Ok(Results { bounded, singular, attained, internal, found })
}

/// Result of a subsystem of which nothing is known: its study panicked, or was interrupted.
pub(super) fn lost(study: &Study, error: Option<InternalError>) -> Result<Ran, SimulationError> {
    let simulation = &study.description.simulation;
    let schedule = Schedule::fixed(simulation.duration, simulation.output_step, simulation.output_step);
    let nominal = unknown(study, &schedule, "nominal")?;
    let bounded = Bounded::new(schedule, nominal, Ledger::default(), Doubts::default());
    let internal = error.into_iter().collect();
    let found = Found::nothing(study.description);
    let results = Results { bounded, singular: Vec::new(), attained: None, internal, found };
    Ok(conclude(study, results, None))
}
/// Whether samples reach the end: the validation samples, or with a tolerance the controlling samples.
pub(super) fn try_samples(study: &Study) -> Result<Tried, RunError> {
    let simulation = &study.description.simulation;
    let (duration, output_step) = (simulation.duration, simulation.output_step);
    match simulation.stepping {
        Stepping::Fixed(step) => {
            let fixed = Schedule::fixed(duration, step, output_step).taken(integration(study));
            let Divided { schedule, .. } = divided(study, fixed);
            let progress = Progress::new(usize::MAX, study.progress);
            let validation = validation(study, &schedule, None, Observed::Outputs, &progress)?;
            let Validation { points, simulated, .. } = validation;
            Ok(Tried {
                reached: simulated.stop.as_ref().map_or(schedule.rows, |(stop, _)| stop.row),
                any: simulated.stopped.len() < points.len(),
                stopped: simulated.stopped.iter().map(|&sample| points[sample].clone()).collect(),
            })
        }
        Stepping::Tolerance(tolerance) => {
            (study.stage)("choosing the steps");
            let samples = controlling_samples(study);
            let controlled = schedule_for_tolerance(
                &study.simulator,
                &samples,
                (duration, output_step),
                tolerance,
                study.interruption,
            )?;
            // The nominal sample may be of another part of the box.
            let inside = |sample: &Sample| samples[0] != *sample || study.domain.contains(sample);
            let going = (0..samples.len()).filter(|sample| !controlled.dropped.contains(sample));
            Ok(Tried {
                reached: controlled.complete_rows.min(controlled.schedule.rows),
                any: going.into_iter().any(|sample| inside(&samples[sample])),
                stopped: controlled.dropped.iter().map(|&sample| study.domain.xi(&samples[sample])).collect(),
            })
        }
    }
}
