//! Schedules that resolve what they can, and the samples that tell the error of their steps.

use super::ensemble::Progress;
use super::single::{Study, simulation_error};
use crate::methods::{Ensembles, Observed, Validation};
use crate::model::Stepping;
use crate::simulate::{Controller, Divided, ExcitedMode, Schedule, SimulationError, excited_modes};

impl Study<'_> {
    /// A schedule with those steps divided that do not resolve a function of the time.
    pub(super) fn divided(&self, schedule: Schedule) -> Divided {
        match &self.time_functions {
            Some(functions) => functions.divided(&schedule),
            None => Divided { schedule, unresolved_from: None },
        }
    }

    /// Fast modes that the start excites and a schedule's steps damp. Steps that a tolerance decides follow them.
    pub(super) fn damped_modes(&self, schedule: &Schedule) -> Vec<ExcitedMode> {
        let has_steps = !self.simulator.system.analysis.visits();
        match self.description.simulation.stepping {
            Stepping::Fixed(_) if has_steps && !self.request.is_empty() => {
                excited_modes(&self.simulator, schedule.longest_step())
            }
            _ => Vec::new(),
        }
    }

    /// The validation samples under a schedule and finer ones.
    pub(super) fn validation(
        &self,
        schedule: &Schedule,
        tolerance: Option<Controller>,
        observed: Observed,
        progress: &Progress,
    ) -> Result<Validation, SimulationError> {
        let (halved, odd) = (schedule.refined(2), schedule.at_odds());
        let direct = self.motions(schedule, tolerance, progress);
        let finer_tolerance = tolerance.map(|tolerance| tolerance.for_parts(2));
        let [halved, finer] = [&halved, &odd].map(|schedule| self.motions(schedule, finer_tolerance, progress));
        let ensembles = Ensembles { direct: &direct, halved: &halved, odd: &finer, ratio: schedule.ratio_to(&odd) };
        Validation::run(ensembles, observed, self.request.degree()).map_err(simulation_error)
    }
}
