//! The steps that a study tries first.

use super::controlled::{controlling_samples, schedule_within};
use super::explicit::{explicit_within, has_tighter_steps, may_be_explicit, refused};
use super::plan::StepPlan;
use super::validated::integration;
use crate::model::Stepping;
use crate::numerics::Sample;
use crate::simulate::{Schedule, SimulationError};
use crate::study::problem::Study;

/// The steps that are tried first, and the error that ended their control before the last row, if there is one: the
/// model's own steps, or those within its tolerance at the controlling samples, by the explicit method where `samples`
/// of the study allow it.
pub fn planned(
    study: &Study,
    samples: fn(&Study) -> Vec<Sample>,
) -> Result<(StepPlan, Option<SimulationError>), SimulationError> {
    let simulation = &study.description.simulation;
    let tolerance = match simulation.stepping {
        Stepping::Fixed(step) => {
            let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
            return Ok((StepPlan::fixed(schedule.taken(integration(study))), None));
        }
        Stepping::Tolerance(tolerance) => tolerance,
    };
    if may_be_explicit(study) && has_tighter_steps(study) {
        match explicit_within(study, tolerance, &samples(study))? {
            Ok(schedule) => return Ok((StepPlan::fixed(schedule), None)),
            Err(obstacle) => refused(study, obstacle)?,
        }
    }
    schedule_within(study, tolerance, &controlling_samples(study))
}
