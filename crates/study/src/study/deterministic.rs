//! A mechanism that depends on no uncertain parameter: simulated once, and once more with halved steps for its error,
//! whatever is asked for.

use std::time::Instant;

use super::ensemble::Progress;
use super::explicit::OF_STEPS;
use super::outcome::{Outcome, Results};
use super::reduced::Found;
use super::single::{Study, simulation_error, timed, validation_summary};
use super::step_search::StepSearch;
use crate::methods::{Ensembles, Method, MethodResult, Simulated, Validation};
use crate::numerics::{Ledger, Range};
use crate::simulate::{Controller, Divided, Schedule, SimulationError};

impl Study<'_> {
    /// Every sampled method's bounds are the nominal motion.
    pub(super) fn deterministic(
        &self,
        schedule: &Schedule,
        tolerance: Option<Controller>,
    ) -> Result<Results, SimulationError> {
        let progress = Progress::new(3 * schedule.rows, self.progress);
        let explicit = match self.request.tolerance.filter(|_| self.may_be_explicit() && !schedule.passes_rows()) {
            None => None,
            Some(allowed) => {
                let found =
                    self.explicit_steps(std::slice::from_ref(&self.domain.nominal), schedule, OF_STEPS * allowed)?;
                found.or_else(|obstacle| self.refused(obstacle.into()).map(|()| schedule.clone())).map(Some)?
            }
        };
        let schedule = explicit.as_ref().unwrap_or(schedule);
        let mut steps = StepSearch::new(schedule, self.may_extrapolate());
        (self.stage)("nominal motion");
        loop {
            let Divided { schedule, unresolved_from } = self.divided(steps.schedule());
            let (halved, odd) = (schedule.refined(2), schedule.at_odds());
            let motions = self.motions(&schedule, tolerance, &progress);
            let (nominal, singular) = timed(&schedule, "nominal", || motions.nominal())?;
            let mut results = Results {
                schedule: schedule.clone(),
                unresolved_from,
                switches: None,
                damped: self.damped_modes(&schedule),
                nominal,
                singular,
                seen: Ledger::new(schedule.rows, self.simulator.program.outputs.len()),
                validation: None,
                methods: Vec::new(),
                attained: None,
                halved: Vec::new(),
                internal: Vec::new(),
                found: Found::default(),
            };
            if self.request.is_empty() {
                return Ok(results);
            }
            self.note_nominal(&results.nominal.result, &results.seen);
            let begun = Instant::now();
            let nominal = &results.nominal.result;
            let finer_tolerance = tolerance.map(|tolerance| tolerance.for_parts(2));
            let [finer, at_odds] = [&halved, &odd].map(|schedule| self.motions(schedule, finer_tolerance, &progress));
            let ratio = schedule.ratio_to(&odd);
            let ensembles = Ensembles { direct: &motions, halved: &finer, odd: &at_odds, ratio };
            let validation =
                Validation::of_nominal(ensembles, (&nominal.bands, nominal.reached)).map_err(simulation_error)?;
            if let Some(allowed) = self.request.tolerance
                && steps.adjust(validation.worst_share(allowed, schedule.rows))
            {
                continue;
            }
            let stop = results.nominal.result.simulated.stop.as_ref().map(|(stop, _)| stop);
            let summary = validation_summary(&schedule, &validation, stop, begun);
            for (method, _) in self.request.methods() {
                if method.about().is_sampled {
                    results.methods.push((method, same(&schedule, &results.nominal.result, method)?));
                } else {
                    let of_method = |wanted| wanted == method;
                    let found = self.bound(&motions, &schedule, &validation, &mut results.internal, of_method)?;
                    results.methods.extend(found);
                }
            }
            results.validation = Some((validation, summary));
            results.found = self.reduced(&results, tolerance, &progress)?;
            return Ok(results);
        }
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
