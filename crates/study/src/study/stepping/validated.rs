//! Schedules that resolve as much as they can, and the samples that measure the error of their steps.

use super::plan::StepPlan;
use crate::methods::{Ensembles, Observed, Validation, ends_of_combinations};
use crate::model::{SchemeChoice, Simulation, Stepping};
use crate::simulate::{Divided, ExcitedMode, Integration, Schedule, SimulationError, excited_modes};
use crate::study::bounding::simulation_error;
use crate::study::ensemble::Progress;
use crate::study::problem::Study;
use crate::study::stepping::tuning::TUNING;

/// Integration of the steps if no tolerance determines it.
pub fn integration(study: &Study) -> Integration {
    match study.description.simulation.scheme {
        SchemeChoice::Explicit => Integration::Explicit,
        _ => Integration::of_levels(study.description.simulation.extrapolation.unwrap_or(1)),
    }
}

/// Steps of the model; those that are typical if a tolerance determines them.
pub fn typical_steps(simulation: &Simulation) -> Schedule {
    let step = match simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => TUNING.typical_step.min(simulation.output_step),
    };
    Schedule::fixed(simulation.duration, step, simulation.output_step)
}

/// Whether a tolerance may choose levels of extrapolation.
pub fn may_extrapolate(study: &Study) -> bool {
    study.description.simulation.scheme == SchemeChoice::Auto && may_leave_scheme(study)
}

/// Whether motions may be integrated otherwise than by HHT-I3 with the model's levels. Certified bounds enclose the
/// scheme itself.
pub fn may_leave_scheme(study: &Study) -> bool {
    let Simulation { scheme, extrapolation, .. } = study.description.simulation;
    let only_sampled = study.request.methods().iter().all(|(method, _)| method.about().is_sampled);
    scheme != SchemeChoice::Hht && extrapolation.is_none() && only_sampled
}

/// A schedule with those steps divided that do not resolve a function of the time.
pub fn divided(study: &Study, schedule: Schedule) -> Divided {
    // Steps that pass over rows have resolved them as they were chosen.
    let is_resolved = schedule.passes_rows() || study.simulator.system.analysis.is_without_steps();
    let duration = study.description.simulation.duration;
    match if is_resolved { None } else { study.simulator.time_functions(duration) } {
        Some(functions) => functions.divided(&schedule),
        None => Divided { schedule, unresolved_from: None },
    }
}

/// Fast modes that are excited and that a schedule's steps damp. Steps that a tolerance decides follow them.
pub fn damped_modes(study: &Study, schedule: &Schedule) -> Vec<ExcitedMode> {
    let has_steps = !study.simulator.system.analysis.visits();
    match study.description.simulation.stepping {
        // The explicit method damps nothing.
        Stepping::Fixed(_)
            if has_steps
                && !study.request.is_empty()
                && !(schedule.integration == Integration::Explicit || schedule.integration.is_cut()) =>
        {
            // The finest level has the most weight.
            let halvings = schedule.integration.order() - 2;
            match halvings {
                0 => excited_modes(&study.simulator, schedule),
                _ => excited_modes(&study.simulator, &schedule.refined(1 << halvings)),
            }
        }
        _ => Vec::new(),
    }
}

/// The validation samples under a plan and finer ones.
pub fn validation(
    study: &Study,
    plan: &StepPlan,
    observed: Observed,
    progress: &Progress,
) -> Result<Validation, SimulationError> {
    let plans = [plan.halved(), plan.at_odds()];
    let direct = study.motions(plan.steps(), progress);
    let [halved, odd] = plans.each_ref().map(|plan| study.motions(plan.steps(), progress));
    let ratio = plan.schedule.ratio_to(&plans[1].schedule);
    let at_once = study.is_simulated_at_once();
    let ensembles = Ensembles { direct: &direct, halved: &halved, odd: &odd, ratio, at_once };
    let ends = ends_of_combinations(ensembles.direct);
    // Long explicit steps err most where they are hardly stable, which may be anywhere.
    let is_explicit = plan.schedule.integration == Integration::Explicit;
    Validation::run(ensembles, observed, study.request.degree(), ends, is_explicit).map_err(simulation_error)
}
