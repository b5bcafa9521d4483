//! One subsystem's study: the step schedule that all samples share, and the methods under it.

use super::RunError;
use super::answers::{Note, Ran, Results, conclude};
use super::attained::bound_along;
use super::black_box::{ask_nominal, repeat};
use super::bounding::{Bounded, Doubts, note_nominal, timed, unknown};
use super::deterministic::deterministic;
use super::ensemble::{Progress, nominal};
use super::excited::{excited, is_excited};
use super::internal::{InternalError, caught};
use super::price::total_work;
use super::problem::Study;
use super::reduced::{Found, plan_reduction, reduced};
use super::stepping::{
    Balanced, StepPlan, balance, controlling_samples, damped_modes, divided, explicit_samples, integration, planned,
    segmented, switches, validation,
};
use crate::methods::{Method, Observed, Validation};
use crate::model::Stepping;
use crate::numerics::{Ledger, Sample};
use crate::simulate::{Divided, Schedule, SimulationError, schedule_for_tolerance};

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
    // Functions are searched by gradients, which do not pass through events.
    let excited = is_excited(study);
    if let Some(schedule) = if excited { None } else { segmented(study)? } {
        return Ok(conclude(study, methods(study, StepPlan::fixed(schedule))?, None));
    }
    if matches!(study.description.simulation.stepping, Stepping::Tolerance(_)) {
        (study.stage)("choosing the steps");
    }
    ask_nominal(study)?;
    let (plan, failure) = planned(study, explicit_samples)?;
    let failure = failure.map(|failure| Note::of(&failure, "results that do not need this sample are kept"));
    let results = methods(study, plan)?;
    repeat(study, results.bounded.validation.as_ref().map(|(validation, _)| validation))?;
    Ok(conclude(study, results, failure))
}

/// The nominal motion, the validation samples, then every method asked for. With a tolerance for the bounds, the
/// validation samples decide how the plan's steps are divided or joined.
fn methods(study: &Study, plan: StepPlan) -> Result<Results, RunError> {
    plan_reduction(study, &plan)?;
    if study.domain.dimension() == 0 {
        return deterministic(study, &plan);
    }
    let progress = Progress::new(total_work(study, &plan.schedule), study.progress);
    let mut internal = Vec::new();
    let balanced = match study.request.is_empty() {
        true => None,
        false => match caught("the validation samples", || balance(study, &plan, &progress)) {
            Ok(balanced) => Some(balanced?),
            Err(error) => {
                internal.push(error);
                None
            }
        },
    };
    let (plan, unresolved_from, validation) = match balanced {
        Some(Balanced { plan, unresolved_from, validation }) => (plan, unresolved_from, Some(validation)),
        None => {
            let Divided { schedule, unresolved_from } = divided(study, plan.schedule);
            (StepPlan { schedule, ..plan }, unresolved_from, None)
        }
    };
    let schedule = &plan.schedule;
    let switches = match &validation {
        Some((validation, _)) => switches(study, plan.steps(), validation, &mut internal)?,
        None => None,
    };
    let seen = Ledger::new(schedule.rows, study.simulator.program.outputs.len());
    let motions = study.motions(plan.steps(), &progress).noting(Some(&seen));
    (study.stage)("nominal motion");
    let (nominal, singular) = timed(schedule, "nominal", || nominal(&motions))?;
    note_nominal(study, &nominal.result, &seen);
    let (mut methods, mut halved, mut attained) = (Vec::new(), Vec::new(), None);
    if let Some((validation, _)) = &validation {
        validation.note(&seen);
        (methods, attained) =
            bound_along(study, plan.steps(), &progress, Some(&seen), validation, &mut internal, |_| true)?;
        if study.certify_time && !study.interruption.is_asked() {
            let sampled = |method: Method| method.about().is_sampled;
            let finer = plan.halved();
            (halved, _) = bound_along(study, finer.steps(), &progress, None, validation, &mut internal, sampled)?;
        }
    }
    drop(motions);
    let functions = if validation.is_some() { excited(study, schedule)? } else { None };
    let (searched, functions) = functions.unzip();
    let damped = damped_modes(study, schedule);
    let doubts = Doubts { unresolved_from, switches, damped };
    let bounded = Bounded { validation, methods, halved, functions, ..Bounded::new(plan, nominal, seen, doubts) };
    let found = match study.interruption.is_asked() {
        true => Found::default(),
        false => match reduced(study, &bounded, &progress) {
            Err(SimulationError::Interrupted) => Found::nothing(study.description),
            found => found?,
        },
    };
    Ok(Results { bounded, singular, attained, searched, internal, found })
}

/// Result of a subsystem of which nothing is known: its study panicked, or was interrupted.
pub(super) fn lost(study: &Study, error: Option<InternalError>) -> Result<Ran, SimulationError> {
    let simulation = &study.description.simulation;
    let schedule = Schedule::fixed(simulation.duration, simulation.output_step, simulation.output_step);
    let nominal = unknown(study, &schedule, "nominal")?;
    let bounded = Bounded::new(StepPlan::fixed(schedule), nominal, Ledger::default(), Doubts::default());
    let internal = error.into_iter().collect();
    let found = Found::nothing(study.description);
    let results = Results { bounded, singular: Vec::new(), attained: None, searched: None, internal, found };
    Ok(conclude(study, results, None))
}
/// Whether samples reach the end: the validation samples, or with a tolerance the controlling samples.
pub(super) fn try_samples(study: &Study) -> Result<Tried, RunError> {
    let simulation = &study.description.simulation;
    let (duration, output_step) = (simulation.duration, simulation.output_step);
    match simulation.stepping {
        Stepping::Fixed(step) => {
            let fixed = Schedule::fixed(duration, step, output_step).taken(integration(study));
            let plan = StepPlan::fixed(divided(study, fixed).schedule);
            let progress = Progress::new(usize::MAX, study.progress);
            let validation = validation(study, &plan, Observed::Outputs, &progress)?;
            let Validation { points, simulated, .. } = validation;
            Ok(Tried {
                reached: simulated.stop.as_ref().map_or(plan.schedule.rows, |(stop, _)| stop.row),
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
                duration,
                output_step,
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
