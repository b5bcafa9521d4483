//! Schedules that resolve what they can, and the samples that tell the error of their steps.

use super::ensemble::Progress;
use super::single::{Study, simulation_error};
use crate::methods::{Ensembles, Observed, Validation};
use crate::model::{SchemeChoice, Simulation, Stepping};
use crate::simulate::{Controller, Divided, ExcitedMode, Integration, Schedule, SimulationError, excited_modes};

impl Study<'_> {
    /// How steps are taken where no tolerance decides it.
    pub(super) fn integration(&self) -> Integration {
        Integration::of_levels(self.description.simulation.extrapolation.unwrap_or(1))
    }

    /// Whether a tolerance may choose levels of extrapolation. Certified bounds enclose the scheme itself.
    pub(super) fn may_extrapolate(&self) -> bool {
        let Simulation { scheme, extrapolation, .. } = self.description.simulation;
        let only_sampled = self.request.methods().iter().all(|(method, _)| method.about().is_sampled);
        scheme == SchemeChoice::Auto && extrapolation.is_none() && only_sampled
    }

    /// A schedule with those steps divided that do not resolve a function of the time.
    pub(super) fn divided(&self, schedule: Schedule) -> Divided {
        match &self.time_functions {
            Some(functions) => functions.divided(&schedule),
            None => Divided { schedule, unresolved_from: None },
        }
    }

    /// Fast modes that the start excites and a schedule's steps damp. Steps that a tolerance decides follow them.
    pub(super) fn damped_modes(&self, schedule: &Schedule) -> Vec<ExcitedMode> {
        let has_steps = !self.simulator.system.analysis.is_without_steps();
        match self.description.simulation.stepping {
            Stepping::Fixed(_) if has_steps && !self.request.is_empty() => {
                // The finest level has the most weight.
                let halvings = schedule.integration.order() - 2;
                excited_modes(&self.simulator, schedule.longest_step() / (1_u32 << halvings) as f64)
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
