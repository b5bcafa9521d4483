//! A mechanism that depends on no uncertain parameter: simulated once, and once more with halved steps for its error,
//! whatever is asked for.

use super::RunError;
use super::answers::Results;
use super::bounding::{Bounded, Doubts, Outcome, bound, note_nominal, simulation_error, timed, validation_summary};
use super::ensemble::{Progress, nominal};
use super::excited::excited;
use super::problem::Study;
use super::reduced::{Found, reduced};
use super::stepping::tuning::TUNING;
use super::stepping::{
    StepPlan, StepSearch, damped_modes, divided, explicit_steps, has_tighter_steps, may_be_explicit, may_extrapolate,
    refused,
};
use crate::methods::{Ensembles, Method, MethodResult, Simulated, Validation};
use crate::numerics::clock::Instant;
use crate::numerics::{Ledger, Range};
use crate::simulate::{Divided, Schedule, SimulationError};

/// Every sampled method's bounds are the nominal motion.
pub(super) fn deterministic(study: &Study, plan: &StepPlan) -> Result<Results, RunError> {
    let StepPlan { schedule, controller } = plan;
    let progress = Progress::new(3 * schedule.rows, study.progress);
    let is_open = may_be_explicit(study) && !has_tighter_steps(study) && !schedule.passes_rows();
    let explicit = match study.request.tolerance.filter(|_| is_open) {
        None => None,
        Some(allowed) => {
            let found = explicit_steps(
                study,
                std::slice::from_ref(&study.domain.nominal),
                schedule,
                TUNING.explicit_share * allowed,
            )?;
            found.or_else(|obstacle| refused(study, obstacle.into()).map(|()| schedule.clone())).map(Some)?
        }
    };
    let schedule = explicit.as_ref().unwrap_or(schedule);
    let mut steps = StepSearch::new(schedule, may_extrapolate(study));
    (study.stage)("nominal motion");
    loop {
        let Divided { schedule, unresolved_from } = divided(study, steps.schedule());
        let plan = StepPlan { schedule, controller: *controller };
        let schedule = &plan.schedule;
        let motions = study.motions(plan.steps(), &progress);
        let (nominal, singular) = timed(schedule, "nominal", || nominal(&motions))?;
        let damped = damped_modes(study, schedule);
        let seen = Ledger::new(schedule.rows, study.simulator.program.outputs.len());
        let doubts = Doubts { unresolved_from, switches: None, damped };
        let bounded = Bounded::new(plan.clone(), nominal, seen, doubts);
        let (internal, found) = (Vec::new(), Found::default());
        let mut results = Results { bounded, singular, attained: None, searched: None, internal, found };
        if study.request.is_empty() {
            return Ok(results);
        }
        note_nominal(study, &results.bounded.nominal.result, &results.bounded.seen);
        let begun = Instant::now();
        let nominal = &results.bounded.nominal.result;
        let finer = [plan.halved(), plan.at_odds()];
        let [halved, odd] = finer.each_ref().map(|plan| study.motions(plan.steps(), &progress));
        let ratio = schedule.ratio_to(&finer[1].schedule);
        let at_once = study.is_simulated_at_once();
        let ensembles = Ensembles { direct: &motions, halved: &halved, odd: &odd, ratio, at_once };
        let validation =
            Validation::of_nominal(ensembles, &nominal.bands, nominal.reached).map_err(simulation_error)?;
        if let Some(allowed) = study.request.tolerance
            && steps.adjust(validation.worst_share(allowed, schedule.rows))
        {
            continue;
        }
        let stop = results.bounded.nominal.result.simulated.stop.as_ref().map(|(stop, _)| stop);
        let summary = validation_summary(schedule, &validation, stop, begun);
        for (method, _) in study.request.methods() {
            if method.about().is_sampled {
                results.bounded.methods.push((method, same(schedule, &results.bounded.nominal.result, method)?));
            } else {
                let of_method = |wanted| wanted == method;
                let found = bound(study, &motions, schedule, &validation, &mut results.internal, of_method)?;
                results.bounded.methods.extend(found);
            }
        }
        results.bounded.validation = Some((validation, summary));
        // Functions of which no constant is one.
        (results.searched, results.bounded.functions) = excited(study, schedule)?.unzip();
        results.found = reduced(study, &results.bounded, &progress)?;
        return Ok(results);
    }
}

/// A method's bounds that are the nominal motion: without width, and exact but for the steps.
fn same(schedule: &Schedule, nominal: &MethodResult, method: Method) -> Result<Outcome, SimulationError> {
    let known = |range: &Range| if range.lower.is_nan() { f64::NAN } else { 0.0 };
    let result = MethodResult {
        surrogate: nominal.bands.iter().map(|ranges| ranges.iter().map(known).collect()).collect(),
        simulations: 0,
        simulated: Simulated { stop: nominal.simulated.stop.clone(), ..Simulated::default() },
        ..nominal.clone()
    };
    let (outcome, ()) = timed(schedule, method.name(), || Ok((result, ())))?;
    Ok(outcome)
}
