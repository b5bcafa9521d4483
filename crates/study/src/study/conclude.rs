//! From what methods found under one schedule to bounds and a summary.

use symdiff::math;

use super::bands::bands;
use super::internal::{InternalError, caught};
use super::outcome::{Outcome, Ran, Results};
use super::single::Study;
use crate::assemble::ConstraintId;
use crate::methods::{Method, Sensitivity, Stop, StopCause};
use crate::numerics::Sample;
use crate::results::{
    Bounds, Contribution, ContributionSummary, DampedMode, ErrorSummary, MethodSummary, OutputBounds, ParameterSummary,
    SingularSummary, Summary, Witness,
};
use crate::simulate::{EnsembleRun, ExcitedMode, Observed, OpenConstraint, Schedule, SimulationError};

/// Said of results that the user did not wait for.
const INTERRUPTED: &str =
    "interrupted: methods that were done are kept, of the one that was not what it had found of every sample";

/// A mode is reported that moves an output by more than this share of its range.
const WORTH_TELLING: f64 = 1e-3;

/// A step resolves a mode that turns by this angle, rad, in it.
const RESOLVING: f64 = 0.1;

impl Study<'_> {
    /// Bounds up to the last row of which something is known, and the summary.
    pub(super) fn conclude(&self, mut results: Results, note: Option<String>) -> Ran {
        let study = self;
        let stop = results.stops().min_by_key(|(stop, _)| (stop.row, stop.sample)).cloned();
        // Where one method cannot go on, its bounds are unknown from there on, and the others' are kept.
        let rows = results.outcomes().map(|outcome| outcome.result.reached).max().unwrap_or(0);
        let outputs = study.simulator.system.outputs.iter().enumerate().map(|(place, output)| OutputBounds {
            name: output.name.clone(),
            unit: output.unit.clone(),
            display: None,
            nominal: results.nominal.result.bands[place][..rows].iter().map(|range| range.lower).collect(),
            bands: bands(study, &results, place, rows),
        });
        let contributions = contributions(study, &results, rows);
        let bounds = Bounds {
            contributions,
            times: (0..rows).map(|row| results.schedule.time(row)).collect(),
            outputs: outputs.collect(),
            covered: Vec::new(),
            analysis: study.simulator.system.analysis,
            responses: Vec::new(),
            witnesses: witnesses(&results, rows),
        };
        let notes = || results.outcomes().find_map(|outcome| outcome.result.note.clone());
        let interrupted = || study.interruption.is_asked().then(|| INTERRUPTED.to_owned());
        let stopped = stop.map(|(stop, sample)| {
            caught("a message", || failure(study, &results.schedule, &stop, &sample))
                .unwrap_or_else(|error| error.to_string())
        });
        let internal = results.internal.iter().map(InternalError::to_string);
        let failures: Vec<String> = internal.chain(stopped.or(note).or_else(interrupted).or_else(notes)).collect();
        let failure = (!failures.is_empty()).then(|| failures.join("; "));
        let whole = results.whole().min(rows);
        let kept = study.kept(&mut results, whole);
        let summary = summary(study, results, &bounds, failure);
        Ran { bounds, summary, whole, kept }
    }
}

/// The samples at which outputs are least and largest, row by row, of those that were searched for.
fn witnesses(results: &Results, rows: usize) -> Vec<Witness> {
    let Some((_, attained)) = &results.attained else { return Vec::new() };
    let outputs = results.nominal.result.bands.len();
    let of_end = |row: usize, output: usize, is_upper: bool| {
        let (value, sample) = attained.ends(row, output)[usize::from(is_upper)]?;
        Some(Witness { row, output, is_upper, value, parameters: sample.to_vec() })
    };
    let all = (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output)));
    all.flat_map(|(row, output)| [false, true].map(|is_upper| of_end(row, output, is_upper))).flatten().collect()
}

/// Every parameter's contribution to every output's spread, from a method that knows it.
pub(super) fn contributions(study: &Study, results: &Results, rows: usize) -> Vec<Vec<Contribution>> {
    let known = |(_, outcome): &&(Method, Outcome)| outcome.result.sensitivities.iter().flatten().any(Option::is_some);
    let Some((_, outcome)) = results.methods.iter().find(known) else { return Vec::new() };
    let of_parameter = |rows_of_output: &[Option<Sensitivity>], place: usize| {
        let over_time = |pick: fn(&Sensitivity) -> &Vec<f64>| {
            let at = |row: &Option<Sensitivity>| row.as_ref().map_or(f64::NAN, |sensitivity| pick(sensitivity)[place]);
            rows_of_output[..rows].iter().map(at).collect()
        };
        Contribution {
            parameter: study.simulator.system.parameters[place].name.clone(),
            main: over_time(|sensitivity| &sensitivity.main),
            total: over_time(|sensitivity| &sensitivity.total),
            width_without: over_time(|sensitivity| &sensitivity.width_without),
        }
    };
    let parameters = 0..study.domain.dimension();
    let of_output =
        |rows: &Vec<Option<Sensitivity>>| parameters.clone().map(|place| of_parameter(rows, place)).collect();
    outcome.result.sensitivities.iter().map(of_output).collect()
}

/// What happened where a sample stopped, for people.
fn failure(study: &Study, schedule: &Schedule, stop: &Stop, sample: &Sample) -> String {
    let parameters = study.simulator.with_names(sample);
    let Stop { sample: index, time, .. } = *stop;
    match stop.cause.clone() {
        StopCause::NoAnswer { why } => {
            let place = study.description.black_box.as_ref().map(|own| own.place.clone()).unwrap_or_default();
            let failed = SimulationError::NoAnswer { place, why, parameters };
            format!("{failed}; bounds that need it are unknown, a scan is of the others")
        }
        StopCause::SingularJet => {
            format!("{}: Taylor bounds are unknown from there on", SimulationError::SingularJet { time })
        }
        StopCause::Locked { constraint, residual } => {
            let locked = study.simulator.locked(OpenConstraint { constraint, residual }, time, parameters);
            format!("{locked}; results up to that time are kept")
        }
        StopCause::NotConverged { equation } => {
            if let Some(term) = no_number(study, schedule, stop.row, sample) {
                let failed = SimulationError::NotFinite { term, time, parameters };
                return format!("{failed}; results up to that time are kept");
            }
            let equation = study.simulator.equation_name(equation);
            let failed = SimulationError::NotConverged { sample: index, time, equation, parameters };
            format!(
                "{failed}; bounds that need it are kept up to that time, a scan is of those that went on. Try a smaller step"
            )
        }
    }
}

/// The term that is no finite number where a sample stops, if there is one: the sample runs once more, alone.
fn no_number(study: &Study, schedule: &Schedule, row: usize, sample: &Sample) -> Option<String> {
    let mut run = EnsembleRun::start(&study.simulator, std::slice::from_ref(sample), schedule.first_step()).ok()?;
    let stops = run.advance(schedule, 0..row + 1, None, Observed::Outputs, &mut Vec::new());
    run.not_finite(stops.first()?)
}

/// The mode whose damping by the steps moves an output most.
fn damped_mode(results: &Results, bounds: &Bounds) -> Option<DampedMode> {
    let (validation, _) = results.validation.as_ref()?;
    let end = bounds.times.last().copied()?;
    let moved = |mode: &ExcitedMode| {
        let share = |output: usize| mode.lost(output, end) / validation.spans[output];
        (0..bounds.outputs.len()).map(share).filter(|share| share.is_finite()).fold(0.0, f64::max)
    };
    let worst = results.damped.iter().max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    (moved(worst) > WORTH_TELLING).then(|| {
        let step = RESOLVING / worst.frequency;
        let digit = 10.0_f64.powi(math::log10(step).floor() as i32);
        DampedMode { frequency: worst.frequency / std::f64::consts::TAU, step: (step / digit).floor() * digit }
    })
}

fn summary(study: &Study, results: Results, bounds: &Bounds, failure: Option<String>) -> Summary {
    let system = &study.simulator.system;
    let mobility = &study.simulator.mobility;
    let names = |constraints: &[ConstraintId]| system.constraint_names(constraints);
    let damped_mode = damped_mode(&results, bounds);
    let unmet_switch = results.unmet_switch_from().map(|row| results.schedule.time(row.saturating_sub(1)));
    let singular =
        results.singular.iter().map(|pass| SingularSummary { time: pass.time, constraints: names(&pass.constraints) });
    Summary {
        model: study.description.name.clone(),
        mbint: env!("CARGO_PKG_VERSION").to_owned(),
        formulation: system.formulation.name().to_owned(),
        coordinates: system.coordinates_of_motion().count(),
        constraints: system.lambda.len(),
        degrees_of_freedom: mobility.degrees_of_freedom,
        redundant_constraints: names(&mobility.redundant),
        undetermined_outputs: system.output_names(&study.simulator.undetermined),
        singular_at_start: names(&mobility.singular_at_start),
        shared_start: study.simulator.shared.clone(),
        singular_configurations: singular.collect(),
        damped_mode,
        events: study.events_of_parts(&results.schedule),
        unmet_switch,
        too_deep: results.too_deep(),
        beyond_tolerance: results.beyond_tolerance(),
        integration: results.schedule.integration.name(),
        alpha: study.description.simulation.alpha,
        duration: study.description.simulation.duration,
        analysis: study.analysis_summary(),
        black_box: study.source.as_ref().and_then(|source| source.summary()),
        parameters: system
            .parameters
            .iter()
            .map(|parameter| ParameterSummary {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                display: study.description.parameter_units.get(&parameter.name).cloned(),
                nominal: parameter.nominal,
                lower: parameter.lower,
                upper: parameter.upper,
            })
            .collect(),
        assemblies: Vec::new(),
        methods: std::iter::once(results.nominal.summary)
            .chain(results.validation.map(|(_, summary)| summary))
            .chain(results.switches.map(|(_, summary)| summary))
            .chain(results.attained.map(|(outcome, _)| outcome.summary))
            .chain(results.methods.into_iter().map(|(_, outcome)| MethodSummary {
                expanded_outputs: outcome.result.expanded.iter().map(|&k| system.outputs[k].name.clone()).collect(),
                ..outcome.summary
            }))
            .chain(results.halved.into_iter().map(|(method, outcome)| MethodSummary {
                method: format!("{} with halved steps", method.name()),
                ..outcome.summary
            }))
            .chain(results.found.summary)
            .collect(),
        errors: ErrorSummary::of(bounds),
        contributions: ContributionSummary::of(bounds),
        reduced: results.found.reduced,
        requirements: results.found.requirements,
        statistics: None,
        pieces: Vec::new(),
        not_simulated: Vec::new(),
        subsystems: Vec::new(),
        failure,
        is_cut: false,
    }
}
