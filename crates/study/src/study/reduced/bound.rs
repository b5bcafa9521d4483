//! Bounds of reduced outputs, by the methods that bound outputs.

use super::Found;
use super::ensemble::{ReducedEnsemble, Store};
use super::evaluated::Evaluated;
use super::keeping::kept_reduced;
use super::occurring::{InPart, in_part};
use super::plan::ReductionPlan;
use super::slopes::OfValues;
use super::tuning::TUNING;
use super::verdicts::verdicts;
use crate::methods::{
    BandBuilder, BoundingMethod, Ensemble, Ensembles, Expand, Method, MethodResult, Observed, Sampling, Simulated,
    Until, Validation, ends_of_combinations,
};
use crate::model::ReducedOutput;
use crate::numerics::clock::Instant;
use crate::numerics::{Ledger, Range, Sample};
use crate::results::{
    Band, Contribution, MethodSummary, Occurrence, ReducedBand, ReducedContribution, ReducedSummary, WorstCase,
};
use crate::simulate::{Schedule, SimulationError};
use crate::study::attained::attained;
use crate::study::bounding::{Bounded, Doubts, FunctionEnds, Outcome, bands, contributions, simulation_error, timed};
use crate::study::ensemble::Progress;
use crate::study::problem::{Study, problem};
use crate::study::stepping::{StepPlan, divided};

/// Plans the reductions during the motions, by the nominal one.
///
/// # Errors
/// If that cannot be assembled.
pub fn plan_reduction(study: &Study, plan: &StepPlan) -> Result<(), SimulationError> {
    let description = study.description;
    if (description.reduced.is_empty() && description.requirements.is_empty()) || study.store.get().is_some() {
        return Ok(());
    }
    (study.stage)("nominal motion");
    let plan = StepPlan { schedule: divided(study, plan.schedule.clone()).schedule, ..*plan };
    let progress = Progress::new(usize::MAX, study.progress);
    let motions = study.motions(plan.steps(), &progress);
    // A deviation from the nominal motion is rounding in the nominal motion: opposite corners show its course.
    let corner = |xi: f64| study.domain.sample(&vec![xi; study.domain.dimension()]);
    let mut samples = vec![study.domain.nominal.clone()];
    if study.domain.dimension() > 0 {
        samples.extend([corner(-1.0), corner(1.0)]);
    }
    let (outputs, mut values) = (motions.outputs(), Vec::new());
    let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: true };
    motions.simulate(&samples, sampling, &mut |_, rows| values.extend_from_slice(rows)).map_err(simulation_error)?;
    let stride = outputs * samples.len();
    let times: Vec<f64> = (0..values.len() / stride).map(|row| plan.schedule.time(row)).collect();
    let of = |output: usize, sample: usize| -> Vec<f64> {
        values.iter().skip(output * samples.len() + sample).step_by(stride).copied().collect()
    };
    let course = |output: usize| {
        let wider = |a: Vec<f64>, b: Vec<f64>| if Range::of(&b).width() > Range::of(&a).width() { b } else { a };
        // The nominal one, unless another moves much more.
        let nominal = of(output, 0);
        let widest = (1..samples.len()).map(|sample| of(output, sample)).fold(nominal.clone(), wider);
        if Range::of(&widest).width() > TUNING.much_further * Range::of(&nominal).width() { widest } else { nominal }
    };
    study.store.get_or_init(|| Store::new(ReductionPlan::of(description, &times, &course)));
    Ok(())
}

/// Bounds of reduced outputs and verdicts, from the samples of a schedule's bounds.
///
/// # Errors
/// If a sample cannot be assembled.
pub fn reduced(study: &Study, rows: &Bounded, progress: &Progress) -> Result<Found, SimulationError> {
    let Some(store) = study.store.get() else { return Ok(Found::default()) };
    let begun = Instant::now();
    (study.stage)("reduced outputs");
    let (plan, schedule) = (&rows.plan, &rows.plan.schedule);
    let finer = [plan.halved(), plan.at_odds()];
    let motions = study.motions(plan.steps(), progress).noting(Some(&rows.seen));
    let [motions_halved, motions_odd] = finer.each_ref().map(|plan| study.motions(plan.steps(), progress));
    let [halved, odd] = finer.each_ref().map(|plan| &plan.schedule);
    let direct = ReducedEnsemble::new(&motions, store, schedule);
    let with_halved = ReducedEnsemble::new(&motions_halved, store, halved);
    let with_odd = ReducedEnsemble::new(&motions_odd, store, odd);
    let (ratio, at_once) = (schedule.ratio_to(odd), study.is_simulated_at_once());
    let ensembles = Ensembles { direct: &direct, halved: &with_halved, odd: &with_odd, ratio, at_once };
    let slopes = OfValues { study, motions: &motions, values: &direct, schedule };
    let mut results = bounds_of(study, ensembles, &slopes, plan, halved)?;
    let unreliable = rows.unreliable_from().is_some();
    // Evaluations after the run are of constants, and say nothing of excitations that are functions.
    let kept = kept_reduced(study, &mut results, &store.plan.values, unreliable || rows.functions.is_some());
    if let Some(functions) = rows.functions.as_ref().and_then(|own| own.of_values.as_deref()) {
        bound_by_functions(&mut results, functions);
    }
    results.note(&direct);
    let values = Evaluated::new(study, &results, unreliable, store);
    (study.stage)("requirements");
    let requirements = match verdicts(study, &values, rows, [&direct, &with_halved]) {
        Err(SimulationError::Interrupted) => Found::nothing(study.description).requirements,
        found => found?,
    };
    let is_cut = schedule.segments().is_some();
    // Switches within steps shift instants by the steps' errors.
    let in_parts = match is_cut || rows.switched_from().is_none() {
        true => in_parts(study, &results, [&direct, &with_halved], is_cut)?,
        false => Vec::new(),
    };
    // These, and the search for a sample that fails, have simulated some more.
    results.note(&direct);
    let values = Evaluated::new(study, &results, unreliable, store);
    let reduced = study.description.reduced.iter().enumerate();
    let contributions = contributions(study, &results, 1);
    let summary = |(index, own)| {
        let summary = summary_of(study, index, own, &values, &contributions);
        match in_parts.get(index).copied().flatten() {
            Some(in_part) => in_part.bounding(summary, study.request.tolerance, unreliable),
            None => summary,
        }
    };
    let reduced = reduced.map(summary).collect();
    let simulations = motions.over() + motions_halved.over() + motions_odd.over();
    let summary = (simulations > 0).then(|| MethodSummary {
        method: "reduced outputs".to_owned(),
        simulations,
        steps: schedule.steps_before(schedule.rows - 1),
        seconds: Some(begun.elapsed().as_secs_f64()),
        ..MethodSummary::default()
    });
    Ok(Found { reduced, requirements, summary, kept })
}

/// Ends over functions stand for those of constants, which are some of them: over constants, peaks have kinks in which
/// polynomials are off.
fn bound_by_functions(results: &mut Bounded, functions: &FunctionEnds) {
    for (_, Outcome { result, .. }) in &mut results.methods {
        for (index, bands) in result.bands.iter_mut().enumerate() {
            if functions.open(0, index).is_finite() {
                bands[0] = functions.range(0, index);
                result.surrogate[index][0] = 0.0;
            }
        }
    }
    results.functions = Some(functions.clone());
}

/// Bounds of all values by each sampled method.
fn bounds_of(
    study: &Study,
    ensembles: Ensembles,
    slopes: &OfValues,
    plan: &StepPlan,
    halved: &Schedule,
) -> Result<Bounded, SimulationError> {
    let (ensemble, schedule) = (ensembles.direct, &plan.schedule);
    let nominal = nominal_values(study, ensemble)?;
    let (nominal, ()) = timed(schedule, "nominal", || Ok((nominal, ())))?;
    let seen = Ledger::new(1, ensemble.outputs());
    let mut results = Bounded::new(plan.clone(), nominal, seen, Doubts::default());
    let mut request = study.request.clone();
    if request.is_empty() {
        return Ok(results);
    }
    // A reduced output with kinks has no polynomial about the middle.
    request.omit(Method::Taylor);
    if request.methods().iter().all(|(method, _)| !method.about().is_sampled) {
        request.ask(Method::Chebyshev, &problem(study.description, &study.simulator));
    }
    // Channels correspond to coordinates, reduced outputs to outputs.
    if let Some(chebyshev) = &mut request.chebyshev {
        chebyshev.expand = Expand::Coordinates;
    }
    let sampled = request.methods().into_iter().filter(|(method, _)| method.about().is_sampled);
    let sampled: Vec<(Method, &dyn BoundingMethod)> = sampled.collect();
    let summary = MethodSummary { method: "validation".to_owned(), ..results.nominal.summary.clone() };
    if study.domain.dimension() == 0 {
        let validation =
            Validation::of_nominal(ensembles, &results.nominal.result.bands, 1).map_err(simulation_error)?;
        for (method, _) in sampled {
            let known = |range: &Range| if range.lower.is_nan() { f64::NAN } else { 0.0 };
            let own = &results.nominal.result;
            let surrogate = own.bands.iter().map(|ranges| ranges.iter().map(known).collect()).collect();
            let result = MethodResult { surrogate, ..own.clone() };
            results.methods.push((method, timed(schedule, method.name(), || Ok((result, ())))?.0));
        }
        results.validation = Some((validation, summary));
        return Ok(results);
    }
    let ends = ends_of_combinations(ensembles.direct);
    // Steps are chosen for outputs, which have halved steps at all samples where these are explicit.
    let validation =
        Validation::run(ensembles, Observed::Motion, study.request.degree(), ends, false).map_err(simulation_error)?;
    if !slopes.jump()
        && let Some((_, _, ends)) = attained(study, slopes.values, slopes, schedule, &validation)?
    {
        slopes.values.follow(ends);
    }
    let bound = |ensemble: &dyn Ensemble, schedule: &Schedule| {
        let of_method = |&(method, own): &(Method, &dyn BoundingMethod)| {
            let bound = || Ok((own.bound(ensemble, &validation, &request).map_err(simulation_error)?, ()));
            Ok((method, timed(schedule, method.name(), bound)?.0))
        };
        sampled.iter().map(of_method).collect::<Result<Vec<(Method, Outcome)>, SimulationError>>()
    };
    results.methods = bound(ensemble, schedule)?;
    if study.certify_time {
        results.halved = bound(ensembles.halved, halved)?;
    }
    results.validation = Some((validation, summary));
    Ok(results)
}

/// Bounds of instants that only a part of the box has.
fn in_parts(
    study: &Study,
    bounded: &Bounded,
    values: [&ReducedEnsemble; 2],
    is_cut: bool,
) -> Result<Vec<Option<InPart>>, SimulationError> {
    let is_asked = bounded.methods.iter().any(|(method, _)| *method == Method::Chebyshev);
    let Some((validation, _)) = bounded.validation.as_ref().filter(|_| is_asked) else { return Ok(Vec::new()) };
    let degree = study.request.degree();
    let of = |value| in_part(value, values, is_cut, validation, degree).map_err(simulation_error);
    (0..study.description.reduced.len()).map(of).collect()
}

/// The nominal motion's values as bands without width.
fn nominal_values(study: &Study, ensemble: &dyn Ensemble) -> Result<MethodResult, SimulationError> {
    let mut bands = BandBuilder::new(ensemble.outputs(), 1);
    let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: true };
    let nominal = std::slice::from_ref(&study.domain.nominal);
    let mut take = |_, values: &[f64]| {
        for (index, &value) in values.iter().enumerate() {
            bands.set(0, index, Range { lower: value, upper: value }, 0.0);
        }
    };
    ensemble.simulate(nominal, sampling, &mut take).map_err(simulation_error)?;
    Ok(bands.finish(0, Simulated::default()))
}

fn summary_of(
    study: &Study,
    index: usize,
    reduced: &ReducedOutput,
    values: &Evaluated,
    contributions: &[Vec<Contribution>],
) -> ReducedSummary {
    let band = |band: Band| ReducedBand {
        method: band.method.name().to_owned(),
        lower: band.lower[0],
        upper: band.upper[0],
        error: band.error.total[0],
        surrogate: band.error.surrogate,
        time: band.error.time,
        unresolved: band.error.unresolved[0] || values.unreliable,
    };
    let of_parameter = |contribution: &Contribution| ReducedContribution {
        parameter: contribution.parameter.clone(),
        main: contribution.main[0],
        total: contribution.total[0],
        width_without: contribution.width_without[0],
    };
    let mut contributions: Vec<ReducedContribution> =
        contributions.get(index).into_iter().flatten().map(of_parameter).collect();
    contributions.retain(|contribution| contribution.total.is_finite());
    contributions.sort_by(|a, b| b.total.total_cmp(&a.total));
    let known = || values.samples.iter().filter(|(_, values)| !values[index].is_nan());
    let case = |(sample, values): &(Sample, Vec<f64>)| WorstCase { parameters: sample.to_vec(), value: values[index] };
    // Those are of constants.
    let known_of_functions = values.bounded.functions.is_some();
    let least = known().min_by(|a, b| a.1[index].total_cmp(&b.1[index])).map(case);
    let greatest = known().max_by(|a, b| a.1[index].total_cmp(&b.1[index])).map(case);
    let absent = values.samples.iter().find(|(_, values)| values[index].is_nan());
    let absent = absent.map(|(sample, _)| sample.to_vec());
    let occurs = Occurrence { samples: known().count(), of: values.samples.len(), absent, share: None };
    ReducedSummary {
        name: reduced.name.clone(),
        of: reduced.text.clone(),
        unit: reduced.unit.clone(),
        display: study.description.display.get(&reduced.name).cloned(),
        nominal: values.bounded.nominal.result.bands[index][0].lower,
        bands: bands(study, values.bounded, index, 1).into_iter().map(band).collect(),
        contributions,
        worst: least.zip(greatest).filter(|_| !known_of_functions).map(|(least, greatest)| [least, greatest]),
        occurs: (occurs.samples < occurs.of).then_some(occurs),
    }
}
