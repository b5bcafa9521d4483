//! The steps whose errors take their share of the bounds' tolerance, with the validation samples that measure them.

use super::explicit::{balance_explicit, has_tighter_steps, may_be_explicit, refused};
use super::plan::StepPlan;
use super::search::StepSearch;
use super::validated::{divided, may_extrapolate, validation};
use crate::methods::{BoundingMethod, Method, Observed, Validation};
use crate::numerics::clock::Instant;
use crate::results::MethodSummary;
use crate::simulate::{Divided, SimulationError};
use crate::study::bounding::validation_summary;
use crate::study::ensemble::Progress;
use crate::study::problem::{Study, problem};

/// A plan whose steps take their share of the bounds' tolerance.
pub struct Balanced {
    pub plan: StepPlan,
    /// The first row before which a step does not resolve a function of the time.
    pub unresolved_from: Option<usize>,
    /// The samples that measure its errors, with their line in the summary.
    pub validation: (Validation, MethodSummary),
}

/// The validation samples, and the plan whose steps take their share of the bounds' tolerance, if there is one.
pub fn balance(study: &Study, plan: &StepPlan, progress: &Progress) -> Result<Balanced, SimulationError> {
    (study.stage)("validation samples");
    let problem = problem(study.description, &study.simulator);
    let needs_motion = |(_, method): &(Method, &dyn BoundingMethod)| method.observes(&problem) == Observed::Motion;
    let motion = study.request.methods().iter().any(needs_motion);
    let observed = if motion { Observed::Motion } else { Observed::Outputs };
    let is_open = may_be_explicit(study) && !has_tighter_steps(study) && !plan.schedule.ends_at_events();
    if let Some(allowed) = study.request.tolerance.filter(|_| is_open) {
        match balance_explicit(study, &plan.schedule, allowed, observed, progress)? {
            Ok((schedule, validation)) => {
                return Ok(Balanced { plan: StepPlan::fixed(schedule), unresolved_from: None, validation });
            }
            Err(obstacle) => refused(study, obstacle)?,
        }
    }
    let mut steps = StepSearch::new(&plan.schedule, may_extrapolate(study));
    loop {
        let begun = Instant::now();
        let Divided { schedule, unresolved_from } = divided(study, steps.schedule());
        let controller = plan.controller.map(|controller| controller.for_parts(steps.parts()));
        let plan = StepPlan { schedule, controller };
        let validation = validation(study, &plan, observed, progress)?;
        let stop = validation.simulated.stop.as_ref().map(|(stop, _)| stop);
        let summary = validation_summary(&plan.schedule, &validation, stop, begun);
        let enough = match study.request.tolerance {
            Some(allowed) => !steps.adjust(validation.worst_share(allowed, plan.schedule.rows)),
            None => true,
        };
        if enough {
            return Ok(Balanced { plan, unresolved_from, validation: (validation, summary) });
        }
    }
}
