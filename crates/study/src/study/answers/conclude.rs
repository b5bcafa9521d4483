//! Bounds and a summary from the results of the methods under one schedule.

use super::analysis::analysis_summary;
use super::functions::{excitations, function_witnesses};
use super::keeping::kept;
use super::results::{Ran, Results};
use crate::study::black_box::no_answer;
use crate::study::bounding::{bands, contributions};
use crate::study::gradient::along_nominal;
use crate::study::internal::caught;
use crate::study::problem::Study;
use crate::study::stepping::{StepPlan, events_followed, events_of_parts};
use symdiff::math;

use super::tuning::TUNING;
use crate::assemble::ConstraintId;
use crate::methods::{Stop, StopCause};
use crate::model::Stepping;
use crate::numerics::Sample;
use crate::results::{
    Bounds, ContributionSummary, DampedMode, ErrorSummary, MethodSummary, OutputBounds, OutputDerivatives,
    ParameterSummary, SingularSummary, StartOverlap, Summary, Witness,
};
use crate::simulate::{
    EnsembleRun, ExcitedMode, Integrator, Observed, OpenConstraint, Schedule, SimulationError, Steps, overlapping,
};
use crate::syntax::{Code, Coded};

/// Said of results that the user did not wait for.
const INTERRUPTED: &str =
    "interrupted: results of finished methods are kept, and of the unfinished one those known for every sample";

/// Why a run ended early, or which of its results are omitted, for people.
pub struct Note {
    text: String,
    code: Option<Code>,
}

impl Note {
    /// The error that stopped a run, and the results that are stored.
    pub fn of(error: &SimulationError, kept: &str) -> Self {
        Self { text: format!("{error}; {kept}"), code: error.code() }
    }

    fn uncoded(text: impl ToString) -> Self {
        Self { text: text.to_string(), code: None }
    }
}

/// Bounds up to the last row of which something is known, and the summary.
pub fn conclude(study: &Study, mut results: Results, note: Option<Note>) -> Ran {
    let stop = results.bounded.stops().min_by_key(|(stop, _)| (stop.row, stop.sample)).cloned();
    // If one method cannot go on, its bounds are unknown from there on; the bounds of the others remain.
    let rows = results.bounded.outcomes().map(|outcome| outcome.result.reached).max().unwrap_or(0);
    let outputs = study.simulator.system.outputs.iter().enumerate().map(|(index, output)| OutputBounds {
        name: output.name.clone(),
        unit: output.unit.clone(),
        display: None,
        nominal: results.bounded.nominal.result.bands[index][..rows].iter().map(|range| range.lower).collect(),
        bands: bands(study, &results.bounded, index, rows),
    });
    let contributions = contributions(study, &results.bounded, rows);
    let bounds = Bounds {
        contributions,
        times: (0..rows).map(|row| results.bounded.plan.schedule.time(row)).collect(),
        outputs: outputs.collect(),
        covered: Vec::new(),
        analysis: study.simulator.system.analysis,
        responses: Vec::new(),
        witnesses: witnesses(&results, rows),
        derivatives: derivatives(study, &results.bounded.plan, rows),
        functions: function_witnesses(study, &results.bounded),
        certified: results.bounded.outcomes().filter_map(|outcome| outcome.result.certified.clone()).collect(),
    };
    let noted = || results.bounded.outcomes().find_map(|outcome| outcome.result.note.clone());
    let interrupted = || study.interruption.is_asked().then(|| Note::uncoded(INTERRUPTED));
    let stopped = stop.map(|(stop, sample)| {
        caught("a message", || failure(study, &results.bounded.plan.schedule, &stop, &sample))
            .unwrap_or_else(Note::uncoded)
    });
    let internal = results.internal.iter().map(Note::uncoded);
    let notes = || noted().map(Note::uncoded);
    let failures: Vec<Note> = internal.chain(stopped.or(note).or_else(interrupted).or_else(notes)).collect();
    let whole = results.bounded.whole().min(rows);
    let kept = kept(study, &mut results, whole);
    let summary = summary(study, results, &bounds, &failures);
    Ran { bounds, summary, whole, kept }
}

/// Derivatives of all outputs at the nominal parameters, if they are wanted and there are any.
fn derivatives(study: &Study, plan: &StepPlan, rows: usize) -> Vec<OutputDerivatives> {
    let outputs: Vec<usize> = (0..study.simulator.system.outputs.len()).collect();
    let has_them = study.source.is_none() && study.domain.dimension() > 0 && !outputs.is_empty();
    if !study.derivatives || !has_them || study.interruption.is_asked() {
        return Vec::new();
    }
    (study.stage)("derivatives");
    let Ok(found) = along_nominal(study, plan, &outputs) else { return Vec::new() };
    let is_trusted = |row: usize| found.unreliable_from.is_none_or(|from| plan.schedule.time(row) < from);
    let of_output = |output: usize| {
        let of_rows = found.rows.iter().skip(output).step_by(outputs.len()).take(rows).enumerate();
        let by_parameters = of_rows.flat_map(|(row, own)| {
            let trusted = is_trusted(row);
            own.by_parameters.iter().map(move |&by| if trusted { by } else { f64::NAN })
        });
        OutputDerivatives { output, by_parameters: by_parameters.collect() }
    };
    outputs.iter().map(|&output| of_output(output)).collect()
}

/// The samples at which outputs are least and largest, row by row, of those that were searched for.
fn witnesses(results: &Results, rows: usize) -> Vec<Witness> {
    let Some((_, attained)) = &results.attained else { return Vec::new() };
    let outputs = results.bounded.nominal.result.bands.len();
    let of_end = |row: usize, output: usize, is_upper: bool| {
        let (value, sample) = attained.ends(row, output)[usize::from(is_upper)]?;
        Some(Witness { row, output, is_upper, value, parameters: sample.to_vec() })
    };
    let all = (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output)));
    all.flat_map(|(row, output)| [false, true].map(|is_upper| of_end(row, output, is_upper))).flatten().collect()
}

/// The reason why a sample stopped, for people.
fn failure(study: &Study, schedule: &Schedule, stop: &Stop, sample: &Sample) -> Note {
    let parameters = study.simulator.with_names(sample);
    let Stop { sample: index, time, .. } = *stop;
    match stop.cause.clone() {
        StopCause::NoAnswer { why } => {
            let failed = no_answer(study, sample, why);
            Note::of(&failed, "bounds that need it are unknown, a scan is of the others")
        }
        StopCause::SingularJet => {
            let failed = SimulationError::SingularJet { time };
            Note { text: format!("{failed}: Taylor bounds are unknown from there on"), code: failed.code() }
        }
        StopCause::Locked { constraint, residual } => {
            let locked = study.simulator.locked(OpenConstraint { constraint, residual }, time, parameters);
            Note::of(&locked, "results up to that time are kept")
        }
        StopCause::NotConverged { equation } => {
            if let Some(term) = no_number(study, schedule, stop.row, sample) {
                let failed = SimulationError::NotFinite { term, time, parameters };
                return Note::of(&failed, "results up to that time are kept");
            }
            let equation = study.simulator.equation_name(equation);
            let failed = SimulationError::NotConverged { sample: index, time, equation, parameters };
            Note::of(
                &failed,
                "bounds that need it are kept up to that time, a scan is of those that went on. Try a smaller step",
            )
        }
    }
}

/// The term that is no finite number where a sample stops, if there is one: the sample runs once more, alone.
fn no_number(study: &Study, schedule: &Schedule, row: usize, sample: &Sample) -> Option<String> {
    let mut run = EnsembleRun::start(&study.simulator, std::slice::from_ref(sample), schedule.first_step()).ok()?;
    let stops = run.advance(Steps { schedule, controller: None }, 0..row + 1, Observed::Outputs, &mut Vec::new());
    run.not_finite(stops.first()?)
}

/// The mode whose damping by the steps moves an output most.
fn damped_mode(results: &Results, bounds: &Bounds) -> Option<DampedMode> {
    let (validation, _) = results.bounded.validation.as_ref()?;
    let end = bounds.times.last().copied()?;
    let moved = |mode: &ExcitedMode| {
        let share = |output: usize| mode.lost(output, end) / validation.spans[output];
        (0..bounds.outputs.len()).map(share).filter(|share| share.is_finite()).fold(0.0, f64::max)
    };
    let worst = results.bounded.doubts.damped.iter().max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    (moved(worst) > TUNING.worth_telling).then(|| {
        let step = TUNING.resolving_angle / worst.frequency;
        let digit = 10.0_f64.powi(math::log10(step).floor() as i32);
        DampedMode { frequency: worst.frequency / std::f64::consts::TAU, step: (step / digit).floor() * digit }
    })
}

fn summary(study: &Study, results: Results, bounds: &Bounds, failures: &[Note]) -> Summary {
    let system = &study.simulator.system;
    let mobility = &study.simulator.mobility;
    let names = |constraints: &[ConstraintId]| system.constraint_names(constraints);
    let damped_mode = damped_mode(&results, bounds);
    let excitations = excitations(study, &results.bounded, bounds);
    let schedule = &results.bounded.plan.schedule;
    let before = |row: usize| schedule.time(row.saturating_sub(1));
    let unmet_switch = results.bounded.unmet_switch_from().map(before);
    let is_fixed = matches!(study.description.simulation.stepping, Stepping::Fixed(_));
    let passed_force = results.bounded.passed_from().filter(|_| is_fixed && !schedule.ends_at_events()).map(before);
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
        events: events_of_parts(study, schedule),
        events_followed: events_followed(schedule),
        unmet_switch,
        passed_force,
        overlaps_at_start: overlapping(&study.simulator)
            .into_iter()
            .map(|(contact, depth)| StartOverlap { contact, depth })
            .collect(),
        too_deep: results.bounded.too_deep(),
        beyond_tolerance: results.bounded.beyond_tolerance(),
        integration: schedule.integration.name(),
        alpha: study.description.simulation.alpha,
        duration: study.description.simulation.duration,
        analysis: analysis_summary(study),
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
        chains: Vec::new(),
        methods: std::iter::once(results.bounded.nominal.summary)
            .chain(results.bounded.validation.map(|(_, summary)| summary))
            .chain(results.bounded.doubts.switches.map(|(_, summary)| summary))
            .chain(results.attained.map(|(outcome, _)| outcome.summary))
            .chain(results.searched.map(|outcome| outcome.summary))
            .chain(results.bounded.methods.into_iter().map(|(_, outcome)| MethodSummary {
                expanded_outputs: outcome.result.expanded.iter().map(|&k| system.outputs[k].name.clone()).collect(),
                ..outcome.summary
            }))
            .chain(results.bounded.halved.into_iter().map(|(method, outcome)| MethodSummary {
                method: format!("{} with halved steps", method.name()),
                ..outcome.summary
            }))
            .chain(results.found.summary)
            .collect(),
        errors: ErrorSummary::of(bounds),
        excitations,
        realisations: Vec::new(),
        contributions: ContributionSummary::of(bounds),
        reduced: results.found.reduced,
        requirements: results.found.requirements,
        statistics: None,
        pieces: Vec::new(),
        not_simulated: Vec::new(),
        subsystems: Vec::new(),
        failure: (!failures.is_empty())
            .then(|| failures.iter().map(|failure| failure.text.as_str()).collect::<Vec<_>>().join("; ")),
        failure_code: failures.iter().find_map(|failure| failure.code),
        is_cut: false,
        chosen_formulation: None,
    }
}
