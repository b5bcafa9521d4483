//! Computing time against accuracy: a work-precision study of one model.
//!
//! `grid` lists the settings; `plan` which reference can be had, and `reference` computes it with its own error; every
//! setting is run as `batch::run` runs a model, against the clock (`timing`), and `deviation` says how far its bounds
//! are off. `integrators` does the same with other schemes on the nominal trajectory.

mod deviation;
mod grid;
mod integrators;
mod plan;
mod reference;
mod timing;
pub(crate) mod tuning;

use crate::compile::compile_switches;
use crate::methods::{MOST_SIMULATIONS, Varied, can_compose};
use crate::model::{Description, Stepping};
use crate::numerics::clock::Instant;
use crate::results::{CostMethod, CostPoint, CostReference, CostStudy, cost_curves, pareto};
use crate::study::black_box::needs_mechanism;
use crate::study::{RunError, prepare, scheme};
use crate::syntax::{Code, Coded};

use grid::{Setting, settings, smoothest, uncertain};
use plan::ReferencePlan;
use reference::Reference;
use timing::{method, timed};
use tuning::TUNING;

/// Options of a cost study.
#[derive(Clone, Copy)]
pub struct CostOptions<'a> {
    /// Error that is wanted, relative to each output's scale.
    pub tolerance: f64,
    /// s, about. The reference is as fine as a third of it allows; without time for a coarse one, nothing is run.
    pub budget: f64,
    /// Threads; all cores if absent.
    pub threads: Option<usize>,
    /// Called now and then with the fraction that is done.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Asked now and then whether to end; measurements made by then remain.
    pub interrupted: &'a (dyn Fn() -> bool + Sync),
}

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// The model cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The reference was not computed to the end.
    #[error("the reference did not come to its end: {0}")]
    Reference(String),
    /// A reference would take most of the budget, or more.
    #[error("even a coarse reference takes {seconds:.1} s")]
    TooCostly {
        /// Time that it takes, s.
        seconds: f64,
    },
    /// A reference would take too many simulations.
    #[error("{parameters} uncertain parameters: even a coarse reference takes {simulations:.1e} simulations")]
    TooMany {
        /// Number of uncertain parameters.
        parameters: usize,
        /// Simulations of the reference.
        simulations: f64,
    },
}

/// Studies a model: every setting of the grid that the budget allows, cheap ones first.
///
/// # Errors
/// If the model cannot be run at all, or the reference cannot be computed.
pub fn cost(model: &Description, options: &CostOptions) -> Result<CostStudy, CostError> {
    needs_mechanism(model, "a study of methods and integrators").map_err(RunError::from)?;
    let begun = Instant::now();
    let system = prepare(model)?.system;
    let k = uncertain(model);
    let composable = can_compose(k, system.q.len());
    let is_over = |budget: f64| move || (options.interrupted)() || begun.elapsed().as_secs_f64() > budget;
    let over = is_over(options.budget);
    let within = CostOptions { interrupted: &over, ..*options };
    let progress = |done| (options.progress)(TUNING.reference_done * done);
    let is_fixed = matches!(model.simulation.stepping, Stepping::Fixed(_));
    let has_expansion = is_fixed && compile_switches(&system).is_none() && !system.analysis.is_without_steps();
    let planned = ReferencePlan::within_budget(model, composable, has_expansion, &within)
        .and_then(|plan| Ok((Reference::compute(model, &plan, &within, &progress)?, plan)));
    let (reference, plan) = match planned {
        Ok(found) => found,
        Err(CostError::TooCostly { seconds }) if !(options.interrupted)() => {
            return Ok(without_reference(model, composable, options, seconds.max(begun.elapsed().as_secs_f64())));
        }
        // Settings cut short at the end of the budget.
        Err(CostError::Reference(_)) if !(options.interrupted)() && over() => {
            return Ok(without_reference(model, composable, options, begun.elapsed().as_secs_f64()));
        }
        Err(error) => return Err(error),
    };
    let reference_seconds = begun.elapsed().as_secs_f64();
    let for_bounds = options.budget - (TUNING.for_schemes * options.budget).min(TUNING.most_for_schemes);

    let at_rest = reference.known.at_rest().map(|output| format!("`{output}`: it has nothing to measure errors by"));
    let mut left_out: Vec<String> = at_rest.collect();
    let mut bounds = Vec::new();
    if k > 0 {
        if plan.scan.is_none() {
            left_out.push("a dense scan to check the reference by".to_owned());
        }
        if !composable {
            left_out.push("outputs composed from coordinates: the parameters or coordinates are too many".to_owned());
        }
        let settings = settings(&model.simulation, composable);
        let skipped;
        let over = is_over(for_bounds);
        let within = CostOptions { budget: for_bounds, interrupted: &over, ..*options };
        (bounds, skipped) = run_settings(model, &settings, &reference, &within, plan.rate, begun);
        // An interruption is another reason.
        let skipped = skipped.into_iter().filter(|_| !(options.interrupted)());
        left_out.extend(skipped.map(|(method, count)| beyond_budget(method, count, options)));
    }
    let progress = |done: f64| (options.progress)(TUNING.bounds_done + (1.0 - TUNING.bounds_done) * done);
    let over = is_over(options.budget);
    let within = CostOptions { interrupted: &over, ..*options };
    let mut trajectories = integrators::trajectories(model, &system, &reference.known, &progress, &within)?;
    if (options.interrupted)() {
        left_out.push("settings that were not run when the study was interrupted".to_owned());
    } else if over() {
        left_out.push(format!("schemes that the budget of {} s does not allow", options.budget));
    }
    left_out.extend(unfit(&bounds).chain(unfit(&trajectories)));
    left_out.dedup();
    mark(&mut bounds, reference.summary.bounds_error);
    mark(&mut trajectories, reference.summary.trajectory_error);
    Ok(CostStudy {
        model: model.name.clone(),
        tolerance: options.tolerance,
        budget: options.budget,
        reference_seconds,
        seconds: begun.elapsed().as_secs_f64(),
        reference: reference.summary,
        bounds,
        trajectories,
        left_out,
    })
}

/// Integrators that cannot integrate the motion at all, with the reason.
fn unfit(points: &[CostPoint]) -> impl Iterator<Item = String> {
    cost_curves(points).into_iter().filter(|method| method.integrator().is_some()).filter_map(|method| {
        let mut own = points.iter().filter(|point| point.method == method);
        let reason = own.clone().find_map(|point| point.failure.as_ref())?;
        own.all(|point| point.failure.is_some()).then(|| format!("{}: {reason}", method.label()))
    })
}

/// A study without anything to measure errors by, which would have taken `seconds` or more.
fn without_reference(model: &Description, composable: bool, options: &CostOptions, seconds: f64) -> CostStudy {
    let k = uncertain(model);
    let mut skipped: Vec<(CostMethod, usize)> = Vec::new();
    if k > 0 {
        settings(&model.simulation, composable).iter().for_each(|setting| *entry(&mut skipped, setting.method, 0) += 1);
    }
    CostStudy {
        model: model.name.clone(),
        tolerance: options.tolerance,
        budget: options.budget,
        reference_seconds: seconds,
        seconds: options.budget,
        reference: CostReference {
            method: if k > 0 { smoothest(composable) } else { CostMethod::Scheme(scheme(model)) },
            order: 0,
            steps: [model.simulation.stepping; 3],
            bounds_error: f64::INFINITY,
            trajectory_error: f64::INFINITY,
            parts: Vec::new(),
        },
        bounds: Vec::new(),
        trajectories: Vec::new(),
        left_out: skipped.into_iter().map(|(method, count)| beyond_budget(method, count, options)).collect(),
    }
}

fn beyond_budget(method: CostMethod, count: usize, options: &CostOptions) -> String {
    format!("{}: {count} of its settings, which the budget of {} s does not allow", method.label(), options.budget)
}

/// Runs settings by rising work as long as the budget lasts: the time of a method's last run predicts that of its next,
/// and `rate` that of its first. A run that exceeds the budget nevertheless is ended. The points are in the settings'
/// order; also the number of skipped settings by method.
fn run_settings(
    model: &Description,
    settings: &[Setting],
    reference: &Reference,
    options: &CostOptions,
    rate: f64,
    begun: Instant,
) -> (Vec<CostPoint>, Vec<(CostMethod, usize)>) {
    let k = uncertain(model);
    let mut by_work: Vec<usize> = (0..settings.len()).collect();
    by_work.sort_by(|&a, &b| settings[a].work(k).total_cmp(&settings[b].work(k)));
    let total: f64 = settings.iter().map(|setting| setting.work(k)).sum();
    let mut done = 0.0;
    let mut rates: Vec<(CostMethod, f64)> = Vec::new();
    let (mut points, mut skipped) = (vec![None; settings.len()], Vec::new());
    for index in by_work {
        let setting = &settings[index];
        let work = setting.work(k);
        let progress = |fraction: f64| {
            let share = (done + fraction * work) / total;
            (options.progress)(TUNING.reference_done + (TUNING.bounds_done - TUNING.reference_done) * share);
        };
        let rate = entry(&mut rates, setting.method, rate);
        let this = Instant::now();
        let late = (options.interrupted)() || begun.elapsed().as_secs_f64() + *rate * work > options.budget;
        if !late && setting.simulations(k) <= MOST_SIMULATIONS {
            let point = point(model, setting, reference, options, &progress);
            *rate = this.elapsed().as_secs_f64() / work;
            // A run that was cut short measures nothing.
            points[index] = Some(point).filter(|_| !(options.interrupted)());
        }
        if points[index].is_none() {
            *entry(&mut skipped, setting.method, 0) += 1;
        }
        done += work;
    }
    (points.into_iter().flatten().collect(), skipped)
}

/// A method's value in a list, put there if it is missing.
fn entry<T: Copy>(list: &mut Vec<(CostMethod, T)>, method: CostMethod, missing: T) -> &mut T {
    let index = list.iter().position(|(known, _)| *known == method).unwrap_or_else(|| {
        list.push((method, missing));
        list.len() - 1
    });
    &mut list[index].1
}

/// One setting's errors and price.
fn point(
    model: &Description,
    setting: &Setting,
    reference: &Reference,
    options: &CostOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> CostPoint {
    let varied = setting.method.curve().map(|curve| curve.about().varied);
    let order = (varied == Some(Varied::Order)).then_some(setting.count);
    let points = (varied == Some(Varied::Points)).then_some(setting.count);
    let point = CostPoint { order, points, ..CostPoint::without_result(setting.method, setting.stepping) };
    match timed(model, setting, options, progress) {
        Ok(((bounds, summary), seconds)) => {
            let spent = method(&summary, setting);
            let (simulations, steps) = (spent.simulations, spent.steps);
            let deviation = reference.known.of_bounds(&bounds.outputs);
            CostPoint { simulations, steps, seconds, deviation, failure: summary.failure, ..point }
        }
        Err(error) => CostPoint { failure: Some(error.to_string()), ..point },
    }
}

/// Marks settings below the reference's own error, which replaces theirs, and settings on the front.
fn mark(points: &mut [CostPoint], own: f64) {
    for point in points.iter_mut() {
        point.limited = point.deviation.largest() < own;
    }
    let places: Vec<(f64, f64)> = points.iter().map(|point| point.place(own)).collect();
    for index in pareto(&places) {
        points[index].front = true;
    }
}

impl Coded for CostError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::TooCostly { .. } | Self::TooMany { .. } => Some(Code::TooCostly),
            Self::Reference(_) => None,
        }
    }
}
