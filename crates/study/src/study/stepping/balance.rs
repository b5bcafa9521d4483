//! The steps whose errors take their share of the bounds' tolerance, with the validation samples that measure them.

use super::explicit::{balance_explicit, may_be_explicit, refused};
use super::search::StepSearch;
use super::validated::{divided, may_extrapolate, validation};
use crate::methods::{BoundingMethod, Method, Observed, Validation};
use crate::results::MethodSummary;
use crate::simulate::{Controller, Divided, Schedule, SimulationError};
use crate::study::bounding::validation_summary;
use crate::study::ensemble::Progress;
use crate::study::problem::{Study, problem};

/// A schedule, the tolerance that samples keep under it, and the validation samples with their line in the summary.
type Balanced = (Divided, Option<Controller>, (Validation, MethodSummary));

/// The validation samples, and the schedule whose steps take their share of the bounds' tolerance, where there is
/// one.
pub fn balance(
    study: &Study,
    schedule: &Schedule,
    tolerance: Option<Controller>,
    progress: &Progress,
) -> Result<Balanced, SimulationError> {
    (study.stage)("validation samples");
    let problem = problem(study.description, &study.simulator);
    let needs_motion = |(_, method): &(Method, &dyn BoundingMethod)| method.observes(&problem) == Observed::Motion;
    let motion = study.request.methods().iter().any(needs_motion);
    let observed = if motion { Observed::Motion } else { Observed::Outputs };
    let is_open = may_be_explicit(study) && schedule.segments().is_none();
    if let Some(allowed) = study.request.tolerance.filter(|_| is_open) {
        match balance_explicit(study, schedule, allowed, observed, progress)? {
            Ok((schedule, validation)) => {
                return Ok((Divided { schedule, unresolved_from: None }, None, validation));
            }
            Err(obstacle) => refused(study, obstacle)?,
        }
    }
    let mut steps = StepSearch::new(schedule, may_extrapolate(study));
    loop {
        let begun = std::time::Instant::now();
        let Divided { schedule, unresolved_from } = divided(study, steps.schedule());
        let tolerance = tolerance.map(|tolerance| tolerance.for_parts(steps.parts()));
        let validation = validation(study, &schedule, tolerance, observed, progress)?;
        let stop = validation.simulated.stop.as_ref().map(|(stop, _)| stop);
        let summary = validation_summary(&schedule, &validation, stop, begun);
        let enough = match study.request.tolerance {
            Some(allowed) => !steps.adjust(validation.worst_share(allowed, schedule.rows)),
            None => true,
        };
        if enough {
            return Ok((Divided { schedule, unresolved_from }, tolerance, (validation, summary)));
        }
    }
}
