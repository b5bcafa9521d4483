//! One subsystem's study: the step schedule that all samples share, and the methods under it.

use std::sync::{Arc, OnceLock};

use super::black_box::source::Source;
use super::ensemble::{Motions, Progress, Stored};
use super::internal::{InternalError, caught};
use super::outcome::{Outcome, Ran, Results, Tried};
use super::reduced::{Found, Store};
use super::{Options, RunError};
use crate::methods::{
    BandBuilder, BoundingMethod, BoundsRequest, EnsembleError, Interrupted, Method, MethodResult, Observed, Problem,
    Simulated, Stop, Validation, can_compose,
};
use crate::model::{Description, SchemeChoice, Stepping};
use crate::numerics::{Ledger, ParameterBox, Sample};
use crate::results::MethodSummary;
use crate::simulate::{
    Controller, Divided, Interruption, Schedule, SimulationError, Simulator, Steps, TimeFunctions,
    schedule_for_tolerance,
};

/// A compiled subsystem, and its questions.
pub(super) struct Study<'a> {
    pub(super) description: &'a Description,
    pub(super) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) request: BoundsRequest,
    /// Functions of the time in the equations of motion, where there are any.
    pub(super) time_functions: Option<TimeFunctions>,
    /// Whether all samples are simulated with halved steps too.
    pub(super) certify_time: bool,
    /// Reductions of outputs to one number, and their values in samples, if any.
    pub(super) store: OnceLock<Store>,
    pub(super) progress: &'a (dyn Fn(f64) + Sync),
    /// Called with the current activity.
    pub(super) stage: &'a (dyn Fn(&str) + Sync),
    /// Whether to stop with the finished parts.
    pub(super) interruption: Interruption<'a>,
    /// Where simulations are stored, if they are.
    pub(super) stored: Option<Stored<'a>>,
    /// The program that answers instead of a mechanism, if one does.
    pub(super) source: Option<Arc<Source>>,
}

/// What a subsystem is to its bounding methods.
pub(super) fn problem(description: &Description, simulator: &Simulator) -> Problem {
    let parameters = simulator.system.parameters.len();
    let visits = simulator.system.analysis.visits();
    Problem {
        parameters,
        composes: !visits && can_compose(parameters, simulator.system.q.len()),
        has_fixed_steps: matches!(description.simulation.stepping, Stepping::Fixed(_))
            && description.simulation.extrapolation.is_none()
            && description.simulation.scheme != SchemeChoice::Explicit,
        has_equations: description.black_box.is_none(),
        tolerance: description.bounds.tolerance,
    }
}

impl<'a> Study<'a> {
    /// Of a subsystem that is compiled already.
    ///
    /// # Errors
    /// Where a method cannot bound it.
    pub(super) fn new(
        description: &'a Description,
        simulator: Simulator,
        options: &Options<'a>,
    ) -> Result<Self, RunError> {
        let parameters = &simulator.system.parameters;
        let domain = ParameterBox {
            nominal: parameters.iter().map(|parameter| parameter.nominal).collect(),
            lower: parameters.iter().map(|parameter| parameter.lower).collect(),
            upper: parameters.iter().map(|parameter| parameter.upper).collect(),
        };
        let problem = problem(description, &simulator);
        let request = description.bounds.fitted(options.methods.as_deref(), &problem)?;
        let Options { certify_time, progress, stage, interrupted, .. } = *options;
        let has_steps = !simulator.system.analysis.is_without_steps();
        let time_functions =
            if has_steps { TimeFunctions::of(&simulator, description.simulation.duration) } else { None };
        let store = OnceLock::new();
        Ok(Self {
            description,
            simulator,
            domain,
            request,
            time_functions,
            certify_time,
            store,
            progress,
            stage,
            interruption: Interruption::new(interrupted),
            stored: None,
            source: Source::of(description).map(Arc::new),
        })
    }

    /// The same over a part of the box.
    pub(super) fn over<'b>(&'b self, part: &ParameterBox, progress: &'b (dyn Fn(f64) + Sync)) -> Study<'b> {
        let mut request = self.request.clone();
        request.methods_mut().into_iter().for_each(|(_, method)| method.restrict(part, &self.domain));
        let (simulator, time_functions) = (self.simulator.clone(), self.time_functions.clone());
        let (store, source) = (OnceLock::new(), self.source.clone());
        Study { domain: part.clone(), request, progress, simulator, time_functions, store, source, ..*self }
    }

    /// Rows of output that are asked for.
    pub(super) fn rows(&self) -> usize {
        Schedule::rows_of(self.description.simulation.duration, self.description.simulation.output_step)
    }

    /// The motions under a schedule.
    pub(super) fn motions<'s>(
        &'s self,
        schedule: &'s Schedule,
        tolerance: Option<Controller>,
        progress: &'s Progress<'s>,
    ) -> Motions<'s> {
        let motions = Motions::new(&self.simulator, &self.domain, schedule, tolerance, progress, self.interruption);
        motions.keeping(self.store.get()).stored(self.stored).answered_by(self.source.as_deref())
    }

    /// Whether samples reach the end: the validation samples, or with a tolerance the controlling samples.
    pub(super) fn try_samples(&self) -> Result<Tried, RunError> {
        let simulation = &self.description.simulation;
        let (duration, output_step) = (simulation.duration, simulation.output_step);
        match simulation.stepping {
            Stepping::Fixed(step) => {
                let fixed = Schedule::fixed(duration, step, output_step).taken(self.integration());
                let Divided { schedule, .. } = self.divided(fixed);
                let progress = Progress::new(usize::MAX, self.progress);
                let validation = self.validation(&schedule, None, Observed::Outputs, &progress)?;
                let Validation { points, simulated, .. } = validation;
                Ok(Tried {
                    reached: simulated.stop.as_ref().map_or(schedule.rows, |(stop, _)| stop.row),
                    any: simulated.stopped.len() < points.len(),
                    stopped: simulated.stopped.iter().map(|&sample| points[sample].clone()).collect(),
                })
            }
            Stepping::Tolerance(tolerance) => {
                (self.stage)("choosing the steps");
                let samples = self.controlling_samples();
                let controlled = schedule_for_tolerance(
                    &self.simulator,
                    &samples,
                    (duration, output_step),
                    tolerance,
                    self.interruption,
                )?;
                // The nominal sample may be of another part of the box.
                let inside = |sample: &Sample| samples[0] != *sample || self.domain.contains(sample);
                let going = (0..samples.len()).filter(|sample| !controlled.dropped.contains(sample));
                Ok(Tried {
                    reached: controlled.complete_rows.min(controlled.schedule.rows),
                    any: going.into_iter().any(|sample| inside(&samples[sample])),
                    stopped: controlled.dropped.iter().map(|&sample| self.domain.xi(&samples[sample])).collect(),
                })
            }
        }
    }

    /// Runs every method.
    pub(super) fn run(&self) -> Result<Ran, RunError> {
        if let Some(schedule) = self.segmented()? {
            return Ok(self.conclude(self.methods(&schedule, None)?, None));
        }
        let simulation = &self.description.simulation;
        match simulation.stepping {
            Stepping::Fixed(step) => {
                let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
                let results = self.methods(&schedule.taken(self.integration()), None)?;
                self.repeat(&results)?;
                Ok(self.conclude(results, None))
            }
            Stepping::Tolerance(tolerance) => Ok(self.run_controlled(tolerance)?),
        }
    }

    /// The nominal motion, the validation samples, then every method asked for. With a tolerance for the bounds, the
    /// validation samples decide how the schedule's steps are divided or joined.
    pub(super) fn methods(
        &self,
        schedule: &Schedule,
        mut tolerance: Option<Controller>,
    ) -> Result<Results, SimulationError> {
        self.plan_reduction(schedule, tolerance)?;
        if self.domain.dimension() == 0 {
            return self.deterministic(schedule, tolerance);
        }
        let progress = Progress::new(self.total_work(schedule), self.progress);
        let mut internal = Vec::new();
        let (Divided { schedule, unresolved_from }, validation) = if self.request.is_empty() {
            (self.divided(schedule.clone()), None)
        } else {
            match caught("the validation samples", || self.balance(schedule, tolerance, &progress)) {
                Ok(balanced) => {
                    let (schedule, divided, validation) = balanced?;
                    tolerance = divided;
                    (schedule, Some(validation))
                }
                Err(error) => {
                    internal.push(error);
                    (self.divided(schedule.clone()), None)
                }
            }
        };
        let switches = match &validation {
            Some((validation, _)) => {
                self.switches(Steps { schedule: &schedule, controller: tolerance }, validation, &mut internal)?
            }
            None => None,
        };
        let seen = Ledger::new(schedule.rows, self.simulator.program.outputs.len());
        let motions = self.motions(&schedule, tolerance, &progress).noting(&seen);
        (self.stage)("nominal motion");
        let (nominal, singular) = timed(&schedule, "nominal", || motions.nominal())?;
        let (mut methods, mut halved, mut attained) = (Vec::new(), Vec::new(), None);
        self.note_nominal(&nominal.result, &seen);
        if let Some((validation, _)) = &validation {
            validation.note(&seen);
            methods = self.bound(&motions, &schedule, validation, &mut internal, |_| true)?;
            attained = self.attained(&motions, &schedule)?;
            if self.certify_time && !self.interruption.is_asked() {
                let schedule = schedule.refined(2);
                let halved_tolerance = tolerance.map(|tolerance| tolerance.for_parts(2));
                let motions = self.motions(&schedule, halved_tolerance, &progress);
                let sampled = |method: Method| method.about().is_sampled;
                halved = self.bound(&motions, &schedule, validation, &mut internal, sampled)?;
            }
        }
        drop(motions);
        let damped = self.damped_modes(&schedule);
        let found = Found::default();
        let mut results = Results {
            schedule,
            unresolved_from,
            switches,
            damped,
            nominal,
            singular,
            seen,
            validation,
            methods,
            attained,
            halved,
            internal,
            found,
        };
        if !self.interruption.is_asked() {
            results.found = match self.reduced(&results, tolerance, &progress) {
                Err(SimulationError::Interrupted) => Found::nothing(self.description),
                found => found?,
            };
        }
        Ok(results)
    }

    /// Notes the nominal motion where it is one of those that are bounded: a part of the box need not hold it.
    pub(super) fn note_nominal(&self, nominal: &MethodResult, seen: &Ledger) {
        if self.domain.contains(&self.domain.nominal) {
            let bands = nominal.bands.iter().enumerate();
            let rows = bands.flat_map(|(output, ranges)| ranges.iter().enumerate().map(move |own| (output, own)));
            rows.for_each(|(output, (row, &range))| seen.note_range(row, output, range));
        }
    }

    /// Bounds by every requested method that is wanted; those that were not begun at an interruption are left out, and
    /// of those that panic nothing is known.
    pub(super) fn bound(
        &self,
        motions: &Motions,
        schedule: &Schedule,
        validation: &Validation,
        internal: &mut Vec<InternalError>,
        wanted: impl Fn(Method) -> bool,
    ) -> Result<Vec<(Method, Outcome)>, SimulationError> {
        let mut outcomes = Vec::new();
        let mut asked: Vec<(Method, &dyn BoundingMethod)> =
            self.request.methods().into_iter().filter(|(method, _)| wanted(*method)).collect();
        // What follows the response is held against what the others have simulated.
        asked.sort_by_key(|(_, request)| request.samples().is_none());
        for (method, request) in asked {
            if self.interruption.is_asked() {
                break;
            }
            (self.stage)(method.name());
            let bound = || request.bound(motions, validation, &self.request).map_err(simulation_error);
            let before = motions.over();
            let mut outcome = match caught(method.name(), || timed(schedule, method.name(), || Ok((bound()?, ())))) {
                // Others may be complete.
                Ok(Err(SimulationError::Deferred | SimulationError::Interrupted)) => {
                    self.unknown(schedule, method.name())?
                }
                Ok(timed) => timed?.0,
                Err(error) => {
                    internal.push(error);
                    self.unknown(schedule, method.name())?
                }
            };
            if self.interruption.is_asked() && method.about().is_sampled {
                // Not those that were planned.
                outcome.summary.simulations = motions.over() - before;
            }
            outcomes.push((method, outcome));
        }
        outcomes.sort_by_key(|(method, _)| *method);
        Ok(outcomes)
    }

    /// Bounds of which nothing is known.
    fn unknown(&self, schedule: &Schedule, method: &str) -> Result<Outcome, SimulationError> {
        let bands = BandBuilder::new(self.simulator.program.outputs.len(), schedule.rows);
        let missing = Simulated { missing: schedule.rows, ..Simulated::default() };
        let (outcome, ()) = timed(schedule, method, || Ok((bands.finish(0, missing), ())))?;
        Ok(outcome)
    }

    /// Result of a subsystem of which nothing is known: its study panicked, or was interrupted.
    pub(super) fn lost(&self, error: Option<InternalError>) -> Result<Ran, SimulationError> {
        let simulation = &self.description.simulation;
        let schedule = Schedule::fixed(simulation.duration, simulation.output_step, simulation.output_step);
        let nominal = self.unknown(&schedule, "nominal")?;
        let results = Results {
            schedule,
            unresolved_from: None,
            switches: None,
            damped: Vec::new(),
            nominal,
            singular: Vec::new(),
            seen: Ledger::default(),
            validation: None,
            methods: Vec::new(),
            attained: None,
            halved: Vec::new(),
            internal: error.into_iter().collect(),
            found: Found::nothing(self.description),
        };
        Ok(self.conclude(results, None))
    }
}

/// The error of simulations behind that of an ensemble.
pub(super) fn simulation_error(error: EnsembleError) -> SimulationError {
    if error.is::<Interrupted>() {
        return SimulationError::Interrupted;
    }
    // `Motions` has no other errors.
    *error.downcast().expect("motions fail as simulations do")
}

/// A method's result with its line in the summary.
pub(super) fn timed<T>(
    schedule: &Schedule,
    method: &str,
    bound: impl FnOnce() -> Result<(MethodResult, T), SimulationError>,
) -> Result<(Outcome, T), SimulationError> {
    let begun = std::time::Instant::now();
    let (result, other) = bound()?;
    let simulated = &result.simulated;
    let summary = MethodSummary {
        method: method.to_owned(),
        simulations: result.simulations,
        steps: steps(schedule, simulated.stop.as_ref().map(|(stop, _)| stop)),
        newton_iterations: simulated.effort.iterations,
        rank_revealing_solves: simulated.effort.rank_revealing,
        order: result.order.clone(),
        boxes: result.boxes,
        expanded_outputs: Vec::new(),
        seconds: Some(begun.elapsed().as_secs_f64()),
    };
    Ok((Outcome { result, summary }, other))
}

/// The validation samples' line in the summary.
pub(super) fn validation_summary(
    schedule: &Schedule,
    validation: &Validation,
    stop: Option<&Stop>,
    begun: std::time::Instant,
) -> MethodSummary {
    MethodSummary {
        method: "validation".to_owned(),
        simulations: validation.simulations,
        steps: steps(schedule, stop),
        newton_iterations: validation.effort.iterations,
        rank_revealing_solves: validation.effort.rank_revealing,
        order: None,
        boxes: None,
        expanded_outputs: Vec::new(),
        seconds: Some(begun.elapsed().as_secs_f64()),
    }
}

/// Steps up to where a sample stopped, or to the end.
fn steps(schedule: &Schedule, stop: Option<&Stop>) -> usize {
    let before = schedule.steps_before(stop.map_or(schedule.rows, |stop| stop.row).saturating_sub(1));
    before * schedule.integration.steps()
}
