//! Methods, and the bands that each of them finds under one schedule: of outputs in every row, or of reduced outputs in
//! one.
//!
//! `bands` adds the errors, `contributions` each parameter's part in a band's width, and `ends` has the samples that
//! attain the bounds.

mod bands;
mod contributions;
mod ends;
mod functions;
pub(crate) mod tuning;

use super::ensemble::Motions;
use super::internal::{InternalError, caught};
use super::problem::Study;
use super::stepping::StepPlan;
use crate::methods::{
    BandBuilder, BoundingMethod, Ensemble, EnsembleError, Interrupted, Method, MethodResult, Simulated, Stop, TooDeep,
    Validation,
};
use crate::numerics::clock::Instant;
use crate::numerics::{EMPTY, Ledger, ParameterBox, Range, Sample};
use crate::results::MethodSummary;
use crate::simulate::{ExcitedMode, Schedule, SimulationError, SwitchSearch};

pub use bands::{as_constants, bands};
pub use contributions::contributions;
pub use ends::Attained;
pub use functions::{FunctionEnd, FunctionEnds, WorstFunction};

/// A method's result and its line in the summary.
pub struct Outcome {
    pub result: MethodResult,
    pub summary: MethodSummary,
}

/// Contacts and kinks in the equations, with their line in the summary.
pub type Switches = (SwitchSearch, MethodSummary);

/// Methods and their bands under one plan of steps.
pub struct Bounded {
    pub plan: StepPlan,
    /// The nominal motion, or its reduced outputs, as bands without width.
    pub nominal: Outcome,
    /// All that was simulated under the schedule, the nominal motion too if it lies in the box.
    pub seen: Ledger,
    /// Absent if no method is asked for.
    pub validation: Option<(Validation, MethodSummary)>,
    pub methods: Vec<(Method, Outcome)>,
    /// The same with halved steps, if requested.
    pub halved: Vec<(Method, Outcome)>,
    pub doubts: Doubts,
    /// Ends over functions of the time, if something is excited.
    pub functions: Option<FunctionEnds>,
}

/// Errors of the steps that validation samples do not show.
#[derive(Default)]
pub struct Doubts {
    /// The first row before which a step does not resolve a function of the time.
    pub unresolved_from: Option<usize>,
    /// Contacts and kinks, if the equations have any.
    pub switches: Option<Switches>,
    /// Fast modes that the start excites and the steps damp.
    pub damped: Vec<ExcitedMode>,
}

impl Bounded {
    /// The nominal motion, before any method is asked.
    pub fn new(plan: StepPlan, nominal: Outcome, seen: Ledger, doubts: Doubts) -> Self {
        Self { plan, nominal, seen, validation: None, methods: Vec::new(), halved: Vec::new(), doubts, functions: None }
    }

    /// The nominal motion and every method.
    pub fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        std::iter::once(&self.nominal).chain(self.methods.iter().map(|(_, outcome)| outcome))
    }

    /// An output's nominal values by row, each as a range; empty ranges if the box does not contain the nominal
    /// parameters.
    pub fn nominal_within(&self, domain: &ParameterBox, output: usize) -> Vec<Range> {
        let nominal = &self.nominal.result.bands[output];
        let is_within = domain.contains(&domain.nominal);
        nominal.iter().map(|own| if is_within && !own.lower.is_nan() { *own } else { EMPTY }).collect()
    }

    /// Notes all that an ensemble has seen.
    pub fn note(&self, ensemble: &dyn Ensemble) {
        let all = (0..ensemble.rows()).flat_map(|row| (0..ensemble.outputs()).map(move |output| (row, output)));
        all.for_each(|(row, output)| self.seen.note_range(row, output, ensemble.seen(row, output)));
    }

    /// Samples that stopped.
    pub fn stops(&self) -> impl Iterator<Item = &(Stop, Sample)> {
        let validation = self.validation.iter().filter_map(|(validation, _)| validation.simulated.stop.as_ref());
        self.outcomes().filter_map(|outcome| outcome.result.simulated.stop.as_ref()).chain(validation)
    }

    /// Rows that every sample of every method has reached, validation samples included.
    pub fn whole(&self) -> usize {
        let nominal = self.nominal.result.simulated.stop.as_ref().map(|(stop, _)| stop);
        let stops = self.stops().filter(|(stop, _)| !stop.is_of_jet() && nominal != Some(stop));
        stops.map(|(stop, _)| stop.row).min().unwrap_or(self.plan.schedule.rows)
    }

    /// Outcomes of the samples of every method, and of the validation samples.
    fn simulated(&self) -> impl Iterator<Item = &Simulated> {
        let validation = self.validation.iter().map(|(validation, _)| &validation.simulated);
        self.outcomes().map(|outcome| &outcome.result.simulated).chain(validation)
    }

    /// The largest error ratio of a sample, if it is more than 1.
    pub fn beyond_tolerance(&self) -> Option<f64> {
        let ratios = self.simulated().filter_map(|simulated| simulated.worst_ratio.as_ref());
        ratios.map(|(_, ratio)| *ratio).filter(|ratio| *ratio > 1.0).max_by(f64::total_cmp)
    }

    /// The first row before which some parameter values meet a contact or a kink that no sample meets.
    pub fn unmet_switch_from(&self) -> Option<usize> {
        self.doubts.switches.as_ref().and_then(|(found, _)| found.unmet_from)
    }

    /// The first row before which steps have a switch inside them. Steps from a tolerance end there.
    pub fn switched_from(&self) -> Option<usize> {
        self.doubts.switches.as_ref().and_then(|(found, _)| found.switched_from)
    }

    /// The first surfaces that a contact does not hold apart any more, of all samples.
    pub fn too_deep(&self) -> Option<TooDeep> {
        TooDeep::first(self.simulated().filter_map(|simulated| simulated.too_deep.as_ref()))
    }

    /// The first row before which the steps of a sample do not resolve a force, or exceed the tolerance.
    pub fn passed_from(&self) -> Option<usize> {
        let beyond = self.simulated().filter_map(|simulated| simulated.beyond_tolerance_from);
        beyond.chain(self.doubts.unresolved_from).min()
    }

    /// The first row that cannot be relied on, whatever a method says of it.
    pub fn unreliable_from(&self) -> Option<usize> {
        self.unmet_switch_from().into_iter().chain(self.passed_from()).min()
    }
}

/// Notes the nominal motion if it is one of those that are bounded: a part of the box need not contain it.
pub fn note_nominal(study: &Study, nominal: &MethodResult, seen: &Ledger) {
    if study.domain.contains(&study.domain.nominal) {
        let bands = nominal.bands.iter().enumerate();
        let rows = bands.flat_map(|(output, ranges)| ranges.iter().enumerate().map(move |own| (output, own)));
        rows.for_each(|(output, (row, &range))| seen.note_range(row, output, range));
    }
}

/// Bounds by every requested method that is wanted; methods that were not begun at an interruption are omitted, and the
/// results of those that panic are unknown.
pub fn bound(
    study: &Study,
    motions: &Motions,
    schedule: &Schedule,
    validation: &Validation,
    internal: &mut Vec<InternalError>,
    wanted: impl Fn(Method) -> bool,
) -> Result<Vec<(Method, Outcome)>, SimulationError> {
    let mut outcomes = Vec::new();
    let mut asked: Vec<(Method, &dyn BoundingMethod)> =
        study.request.methods().into_iter().filter(|(method, _)| wanted(*method)).collect();
    // Methods that follow the response are checked against the values that the others have simulated.
    asked.sort_by_key(|(_, request)| request.samples().is_none());
    for (method, request) in asked {
        if study.interruption.is_asked() {
            break;
        }
        (study.stage)(method.name());
        let bound = || request.bound(motions, validation, &study.request).map_err(simulation_error);
        let (before, iterations) = (motions.over(), motions.iterations());
        let mut outcome = match caught(method.name(), || timed(schedule, method.name(), || Ok((bound()?, ())))) {
            // Others may be complete.
            Ok(Err(SimulationError::Deferred | SimulationError::Interrupted)) => {
                unknown(study, schedule, method.name())?
            }
            Ok(timed) => timed?.0,
            Err(error) => {
                internal.push(error);
                unknown(study, schedule, method.name())?
            }
        };
        outcome.summary.newton_iterations += motions.iterations() - iterations;
        if study.interruption.is_asked() && method.about().is_sampled {
            // Not those that were planned.
            outcome.summary.simulations = motions.over() - before;
        }
        outcomes.push((method, outcome));
    }
    outcomes.sort_by_key(|(method, _)| *method);
    Ok(outcomes)
}

/// Bounds of which nothing is known.
pub fn unknown(study: &Study, schedule: &Schedule, method: &str) -> Result<Outcome, SimulationError> {
    let bands = BandBuilder::new(study.simulator.program.outputs.len(), schedule.rows);
    let missing = Simulated { missing: schedule.rows, ..Simulated::default() };
    let (outcome, ()) = timed(schedule, method, || Ok((bands.finish(0, missing), ())))?;
    Ok(outcome)
}

/// The error of simulations behind that of an ensemble.
pub fn simulation_error(error: EnsembleError) -> SimulationError {
    if error.is::<Interrupted>() {
        return SimulationError::Interrupted;
    }
    // `Motions` has no other errors.
    *error.downcast().expect("motions fail as simulations do")
}

/// A method's result with its line in the summary.
pub fn timed<T>(
    schedule: &Schedule,
    method: &str,
    bound: impl FnOnce() -> Result<(MethodResult, T), SimulationError>,
) -> Result<(Outcome, T), SimulationError> {
    let begun = Instant::now();
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
pub fn validation_summary(
    schedule: &Schedule,
    validation: &Validation,
    stop: Option<&Stop>,
    begun: Instant,
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
