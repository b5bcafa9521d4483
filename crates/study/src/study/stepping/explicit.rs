//! Whether the explicit method is taken, and with which steps.

use super::controlled::{controlling_samples, steps_error};
use super::validated::{may_extrapolate, typical_steps, validation};
use crate::study::bounding::validation_summary;
use crate::study::ensemble::Progress;
use crate::study::problem::Study;
use crate::study::stepping::tuning::TUNING;

use super::plan::StepPlan;
use crate::methods::{Observed, Validation};
use crate::model::{Description, SchemeChoice, Stepping};
use crate::numerics::clock::Instant;
use crate::numerics::{Sample, spread};
use crate::results::{Decision, MethodSummary};
use crate::simulate::{ExplicitObstacle, Interruption, Schedule, SimulationError, Simulator, explicit_schedule};

/// A schedule with its validation samples, or why the method is not taken.
type Tried = Result<(Schedule, (Validation, MethodSummary)), Obstacle>;

/// Why the explicit method is not taken.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Obstacle {
    /// It cannot integrate the motion.
    #[error("{0}")]
    Explicit(#[from] ExplicitObstacle),
    /// The requested tolerance is not reached.
    #[error("its error does not come down to the tolerance")]
    Inaccurate,
    /// The scheme takes less work.
    #[error("HHT-I3 with the model's steps takes less work")]
    Costlier,
}

/// Whether the explicit method may be taken: if the model asks for it, or under a tolerance if equations do
/// not switch.
pub fn may_be_explicit(study: &Study) -> bool {
    let simulation = &study.description.simulation;
    if study.simulator.system.analysis.is_without_steps() {
        return false;
    }
    let tolerance = study.request.tolerance.is_some() || matches!(simulation.stepping, Stepping::Tolerance(_));
    match simulation.scheme {
        SchemeChoice::Explicit => tolerance,
        SchemeChoice::Auto => tolerance && may_extrapolate(study) && study.simulator.switches().is_none(),
        SchemeChoice::Hht => false,
    }
}

/// Whether the model has a tolerance of its steps that is tighter than that of the bounds: then the steps are not
/// chosen anew for the bounds.
pub fn has_tighter_steps(study: &Study) -> bool {
    let Stepping::Tolerance(tolerance) = study.description.simulation.stepping else { return false };
    study.request.tolerance.is_none_or(|bounds| tolerance < bounds)
}

/// Reports an obstacle to the method as an error, if the model asks for the method.
pub fn refused(study: &Study, obstacle: Obstacle) -> Result<(), SimulationError> {
    match study.description.simulation.scheme {
        SchemeChoice::Explicit => Err(SimulationError::NotExplicit { why: obstacle.to_string() }),
        _ => Ok(()),
    }
}

/// Samples that decide on steps all of them share: those that control other steps, and as many between them as are
/// integrated together. What turns at another speed is elsewhere when a step is long.
pub fn explicit_samples(study: &Study) -> Vec<Sample> {
    let mut samples = controlling_samples(study);
    let k = study.domain.dimension();
    let between = if k == 0 { 0 } else { TUNING.explicit_samples.saturating_sub(samples.len()) };
    samples.extend(study.domain.samples(&spread(k, between)));
    samples
}

/// Steps at which some samples err by no more than this in each, relative to how far the motion goes.
pub fn explicit_steps(
    study: &Study,
    samples: &[Sample],
    base: &Schedule,
    tolerance: f64,
) -> Result<Result<Schedule, ExplicitObstacle>, SimulationError> {
    let (duration, output_step) = (study.description.simulation.duration, study.description.simulation.output_step);
    let asked = study.description.simulation.scheme == SchemeChoice::Explicit;
    let most = if asked {
        TUNING.explicit_most_steps
    } else {
        TUNING.explicit_further_steps + base.steps_before(base.rows - 1)
    };
    explicit_schedule(&study.simulator, samples, duration, output_step, tolerance, most, study.interruption)
}

/// An error over the allowance, and a result that it comes with.
type Judged<T> = Result<Result<(f64, T), Obstacle>, SimulationError>;

/// A schedule whose error over the allowance, as `judge` finds it by its round, is at most `within`; the steps' own
/// tolerance, which begins as a share of `allowed`, is made smaller until it is.
fn explicit_rounds<T>(
    study: &Study,
    samples: &[Sample],
    base: &Schedule,
    [allowed, within]: [f64; 2],
    mut judge: impl FnMut(usize, &Schedule) -> Judged<T>,
) -> Result<Result<(Schedule, T), Obstacle>, SimulationError> {
    let mut tolerance = TUNING.explicit_share * allowed;
    for round in 0..TUNING.explicit_rounds {
        let schedule = match explicit_steps(study, samples, base, tolerance)? {
            Ok(schedule) => schedule,
            Err(obstacle) => return Ok(Err(obstacle.into())),
        };
        let (share, found) = match judge(round, &schedule)? {
            Ok(judged) => judged,
            Err(obstacle) => return Ok(Err(obstacle)),
        };
        if share <= within {
            return Ok(Ok((schedule, found)));
        }
        if share.is_nan() || study.interruption.is_asked() {
            break;
        }
        tolerance *= (TUNING.explicit_aim / share).max(TUNING.explicit_sharpest);
    }
    Ok(Err(Obstacle::Inaccurate))
}

/// A schedule whose errors at the validation samples are within the steps' share of a tolerance of the bounds.
pub fn balance_explicit(
    study: &Study,
    base: &Schedule,
    allowed: f64,
    observed: Observed,
    progress: &Progress,
) -> Result<Tried, SimulationError> {
    let samples = explicit_samples(study);
    let asked = study.description.simulation.scheme == SchemeChoice::Explicit;
    let mut begun = Instant::now();
    explicit_rounds(study, &samples, base, [allowed, TUNING.share], |round, schedule| {
        if round == 0 && !asked && plain_work(&study.simulator, base) < explicit_work(&study.simulator, schedule) {
            let validation = validation(study, &StepPlan::fixed(base.clone()), observed, progress)?;
            if validation.worst_share(allowed, base.rows) <= TUNING.share {
                return Ok(Err(Obstacle::Costlier));
            }
        }
        let validation = validation(study, &StepPlan::fixed(schedule.clone()), observed, progress)?;
        let stop = validation.simulated.stop.as_ref().map(|(stop, _)| stop);
        let summary = validation_summary(schedule, &validation, stop, begun);
        begun = Instant::now();
        Ok(Ok((validation.worst_share(allowed, schedule.rows), (validation, summary))))
    })
}

/// A schedule whose errors at some samples are within a tolerance of the steps.
pub fn explicit_within(
    study: &Study,
    tolerance: f64,
    samples: &[Sample],
) -> Result<Result<Schedule, Obstacle>, SimulationError> {
    let base = typical_steps(&study.description.simulation);
    let judge = |_, schedule: &Schedule| {
        let plan = StepPlan::fixed(schedule.clone());
        Ok(Ok((steps_error(study, &plan, samples)? / tolerance, ())))
    };
    Ok(explicit_rounds(study, samples, &base, [tolerance, 1.0], judge)?.map(|(schedule, ())| schedule))
}

/// Instructions of a sample by the scheme's own steps.
fn plain_work(simulator: &Simulator, schedule: &Schedule) -> usize {
    let program = &simulator.program;
    let of_step = program.instructions() + program.correct().len();
    of_step * schedule.steps_before(schedule.rows - 1)
}

/// Instructions of a sample by the explicit method.
fn explicit_work(simulator: &Simulator, schedule: &Schedule) -> usize {
    let start = &simulator.start;
    let closure =
        if simulator.system.lambda.is_empty() { 0 } else { start.position().len() + start.projection().len() };
    (TUNING.explicit_stages * start.acceleration().len() + TUNING.explicit_closures * closure)
        * schedule.steps_before(schedule.rows - 1)
}

/// The integrator of a subsystem under a tolerance, with the reason; `None` without a tolerance, or if the model
/// chooses it.
pub fn integration_decision(description: &Description, simulator: &Simulator) -> Option<Decision> {
    let simulation = &description.simulation;
    let of_bounds = description.bounds.tolerance;
    let tolerance = match simulation.stepping {
        Stepping::Tolerance(tolerance) => Some(of_bounds.map_or(tolerance, |bounds| bounds.min(tolerance))),
        Stepping::Fixed(_) => of_bounds,
    };
    let open = simulation.scheme == SchemeChoice::Auto && simulation.extrapolation.is_none();
    let tolerance = tolerance.filter(|_| open && !simulator.system.analysis.is_without_steps())?;
    let by_scheme = |why: String| {
        let levels = if of_bounds.is_some() { ", extrapolated where that takes fewer steps" } else { "" };
        Decision { what: format!("integrated by HHT-I3{levels}"), why, saves: None }
    };
    if simulator.switches().is_some() {
        return Some(by_scheme(
            "equations switch, which ends the steps of an explicit method of high order; it is taken between events that all samples meet"
                .to_owned(),
        ));
    }
    let base = typical_steps(simulation);
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let most = TUNING.explicit_further_steps + base.steps_before(base.rows - 1);
    Some(
        match explicit_schedule(
            simulator,
            &[nominal],
            simulation.duration,
            simulation.output_step,
            TUNING.explicit_share * tolerance,
            most,
            Interruption::default(),
        ) {
            Ok(Ok(schedule)) => {
                let steps = schedule.steps_before(schedule.rows - 1);
                let (explicit, plain) = (explicit_work(simulator, &schedule), plain_work(simulator, &base));
                let step = base.first_step();
                let why = format!(
                    "not stiff: about {steps} steps and {explicit} instructions for the nominal sample, where HHT-I3 with steps of {step} s \
                 takes {plain}"
                );
                Decision { what: "integrated by the explicit method of order 8".to_owned(), why, saves: None }
            }
            Ok(Err(obstacle)) => by_scheme(format!("not by the explicit method: {obstacle}")),
            Err(error) => by_scheme(error.to_string()),
        },
    )
}
