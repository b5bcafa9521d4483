//! Schedules that resolve as much as they can, and the samples that measure the error of their steps.

use super::ensemble::Progress;
use super::single::{Study, problem, simulation_error, validation_summary};
use super::step_search::StepSearch;
use crate::methods::{BoundingMethod, Ensembles, Method, Observed, Validation, ends_of_combinations};
use crate::model::{SchemeChoice, Simulation, Stepping};
use crate::results::MethodSummary;
use crate::simulate::{Controller, Divided, ExcitedMode, Integration, Schedule, SimulationError, excited_modes};

/// A schedule, the tolerance that samples keep under it, and the validation samples with their line in the summary.
type Balanced = (Divided, Option<Controller>, (Validation, MethodSummary));

impl Study<'_> {
    /// How steps are taken where no tolerance decides it.
    pub(super) fn integration(&self) -> Integration {
        match self.description.simulation.scheme {
            SchemeChoice::Explicit => Integration::Explicit,
            _ => Integration::of_levels(self.description.simulation.extrapolation.unwrap_or(1)),
        }
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
            // Those have been resolved as they were chosen.
            _ if schedule.passes_rows() => Divided { schedule, unresolved_from: None },
            Some(functions) => functions.divided(&schedule),
            None => Divided { schedule, unresolved_from: None },
        }
    }

    /// Fast modes that are excited and that a schedule's steps damp. Steps that a tolerance decides follow them.
    pub(super) fn damped_modes(&self, schedule: &Schedule) -> Vec<ExcitedMode> {
        let has_steps = !self.simulator.system.analysis.visits();
        match self.description.simulation.stepping {
            // The explicit method damps nothing.
            Stepping::Fixed(_)
                if has_steps
                    && !self.request.is_empty()
                    && !matches!(schedule.integration, Integration::Explicit | Integration::Segments) =>
            {
                // The finest level has the most weight.
                let halvings = schedule.integration.order() - 2;
                match halvings {
                    0 => excited_modes(&self.simulator, schedule),
                    _ => excited_modes(&self.simulator, &schedule.refined(1 << halvings)),
                }
            }
            _ => Vec::new(),
        }
    }

    /// The validation samples, and the schedule whose steps take their share of the bounds' tolerance, where there is
    /// one.
    pub(super) fn balance(
        &self,
        schedule: &Schedule,
        tolerance: Option<Controller>,
        progress: &Progress,
    ) -> Result<Balanced, SimulationError> {
        (self.stage)("validation samples");
        let problem = problem(self.description, &self.simulator);
        let needs_motion = |(_, method): &(Method, &dyn BoundingMethod)| method.observes(&problem) == Observed::Motion;
        let motion = self.request.methods().iter().any(needs_motion);
        let observed = if motion { Observed::Motion } else { Observed::Outputs };
        let is_open = self.may_be_explicit() && schedule.segments().is_none();
        if let Some(allowed) = self.request.tolerance.filter(|_| is_open) {
            match self.balance_explicit(schedule, allowed, observed, progress)? {
                Ok((schedule, validation)) => {
                    return Ok((Divided { schedule, unresolved_from: None }, None, validation));
                }
                Err(obstacle) => self.refused(obstacle)?,
            }
        }
        let mut steps = StepSearch::new(schedule, self.may_extrapolate());
        loop {
            let begun = std::time::Instant::now();
            let Divided { schedule, unresolved_from } = self.divided(steps.schedule());
            let tolerance = tolerance.map(|tolerance| tolerance.for_parts(steps.parts()));
            let validation = self.validation(&schedule, tolerance, observed, progress)?;
            let stop = validation.simulated.stop.as_ref().map(|(stop, _)| stop);
            let summary = validation_summary(&schedule, &validation, stop, begun);
            let enough = match self.request.tolerance {
                Some(allowed) => !steps.adjust(validation.worst_share(allowed, schedule.rows)),
                None => true,
            };
            if enough {
                return Ok((Divided { schedule, unresolved_from }, tolerance, (validation, summary)));
            }
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
        let ends = ends_of_combinations(ensembles.direct);
        Validation::run(ensembles, observed, self.request.degree(), ends).map_err(simulation_error)
    }
}
