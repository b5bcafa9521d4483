//! Nominal values that are best with the tolerances about them.
//!
//! Every candidate has its tolerances (`axes`). One run over the ranges and the tolerances about them gives a surrogate
//! of all margins (`surface`); on it, `worst` finds what the worst case of a candidate leaves, and `search` the local
//! optima, in the order of `goal`. About each of these a surrogate over a narrower region makes the optimum sharper
//! (`refine`), and a study of its own tells its figures (`points`). The same without tolerances finds the optimum that
//! one would have chosen otherwise.

mod axes;
mod goal;
mod instants;
mod points;
mod profiles;
mod refine;
mod search;
mod share;
mod surface;
mod worst;

use std::ops::Range;

use super::{AllocateError, AllocateOptions, Options, RunError, allocate, reduced, statistics};
use crate::model::{Cost, Description, Objective};
use crate::results::{Allocation, Criterion, DesignKind, DesignObjective, DesignParameter, DesignPoint, DesignStudy};
use axes::{Axes, without_tolerances};
use goal::Goal;
use instants::{at_instants, required};
use points::{Studied, not_met, studied};
use profiles::profiles;
use refine::refined;
use search::{are_alike, optima};
use share::Yield;
use surface::Surface;
use worst::{Assessed, Worst};

/// Optima that are reported at most.
const REPORTED: usize = 3;

/// How many times the model's tolerances are allocated, at most.
const WIDEST: f64 = 3.0;

/// Why there is no design.
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// The model asks for something else.
    #[error("{0}")]
    Unsuitable(String),
    /// The model cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The margins are not known over any region.
    #[error("there is no reliable surrogate over the ranges: narrow them, or bound the model with `mbint run` first")]
    NoSurrogate,
    /// It was asked to stop.
    #[error("interrupted before there was a result")]
    Interrupted,
}

/// Question to a model: its requirements, of which the objective's may be the last.
struct Question {
    model: Description,
    /// The same with requirements at instants, of which surrogates are made; and which of these stand for each.
    at_instants: Description,
    instants: Vec<Range<usize>>,
    goal: Goal,
    /// Whether small values of the objective are good.
    is_least: bool,
    /// The share of the production that counts; every case where absent.
    share: Option<f64>,
}

impl Question {
    /// Number of the model's own requirements.
    fn required(&self) -> usize {
        self.model.requirements.len() - usize::from(self.goal == Goal::Last)
    }

    /// The same without tolerances.
    fn without_tolerances(&self) -> Self {
        let [model, at_instants] = [&self.model, &self.at_instants].map(without_tolerances);
        Self { model, at_instants, instants: self.instants.clone(), share: None, ..*self }
    }

    /// What counts of a candidate, on a surrogate.
    fn assessed<'s>(&self, surface: &'s Surface) -> Result<Box<dyn Assessed + 's>, DesignError> {
        let Some(share) = self.share.filter(|_| surface.axes.uncertain() > 0) else {
            return Ok(Box::new(Worst::new(surface)));
        };
        let from = surface.axes.start();
        let laws = statistics::laws(&surface.axes.at(&self.model, &from)).map_err(DesignError::Unsuitable)?;
        Ok(Box::new(Yield::new(surface, self.goal, &laws, &from, share)))
    }
}

/// How a design counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct DesignOptions {
    /// The share of the production that fulfils all requirements and is at least as good as the objective's value;
    /// every case where absent.
    pub share: Option<f64>,
}

/// Finds the nominal values, within the ranges of the model's `design`, that are best in its `objective` with the
/// tolerances about them.
///
/// # Errors
/// Where the model has no `design`, or cannot be run.
pub fn design(description: &Description, asked: DesignOptions, options: &Options) -> Result<DesignStudy, DesignError> {
    let Some(design) = &description.design else {
        let message = "the model has no `design`: name free parameters with their ranges, and an `objective`";
        return Err(DesignError::Unsuitable(message.to_owned()));
    };
    let mut model = description.clone();
    model.design = None;
    model.statistics.asked = false;
    let is_least = matches!(design.objective, Objective::Worst { is_largest: true, .. });
    let objective = match &design.objective {
        Objective::Worst { distance, .. } => {
            model.requirements.push((**distance).clone());
            DesignObjective {
                text: format!("{} {}", distance.name, distance.text),
                unit: distance.unit.clone(),
                display: distance.display.clone(),
                is_least,
            }
        }
        Objective::Margin => {
            DesignObjective { text: "margin".to_owned(), unit: String::new(), display: None, is_least }
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or(0)).build();
    pool.map_err(RunError::from)?.install(|| {
        let model = required(&model);
        let (at_instants, instants) = at_instants(&model);
        let [model, at_instants] = [model, at_instants].map(|own| reduced::expanded(&own).into_owned());
        let axes = Axes::of(&model, &design.free);
        let question = Question { model, at_instants, instants, goal: Goal::of(design), is_least, share: asked.share };
        let mut found = designed(&question, &axes, objective, options)?;
        found.allocation = allocated(description, &axes, &found, asked, options)?;
        Ok(found)
    })
}

/// What the tolerances may become at the best point, and cost against margin there, where they have costs.
fn allocated(
    description: &Description,
    axes: &Axes,
    found: &DesignStudy,
    asked: DesignOptions,
    options: &Options,
) -> Result<Option<Allocation>, DesignError> {
    let is_priced = |cost: &Cost| !matches!(cost, Cost::Fixed);
    let priced = description.statistics.costs.iter().any(|(_, cost)| is_priced(cost));
    let Some(best) = found.best().filter(|best| best.is_feasible && priced) else { return Ok(None) };
    let asked = AllocateOptions { share: asked.share, widest: WIDEST };
    match allocate(&axes.at(description, &best.values), asked, options) {
        Ok(allocation) => Ok(Some(allocation)),
        Err(AllocateError::Unsuitable(_)) => Ok(None),
        Err(AllocateError::Run(error)) => Err(error.into()),
    }
}

fn designed(
    question: &Question,
    axes: &Axes,
    objective: DesignObjective,
    options: &Options,
) -> Result<DesignStudy, DesignError> {
    let mut simulations = 0;
    let mut confirming = 0;
    let mut figures = |point: &[f64], kind: DesignKind| -> Result<Option<DesignPoint>, DesignError> {
        let found = studied(question, axes, point, kind, options)?;
        confirming += found.as_ref().map_or(0, |found| found.simulations + found.of_surrogate);
        Ok(found.map(|found| found.found))
    };
    (options.stage)("the model's own values");
    let model_point = figures(&axes.present(), DesignKind::Model)?;
    let mut known = vec![axes.start()];
    let mut nominal_point = None;
    if axes.uncertain() > 0 {
        (options.stage)("the optimum without tolerances");
        let bare = question.without_tolerances();
        let own = Axes::of(&bare.model, &axes.free);
        let found = found(&bare, &own, &known, 1, options)?;
        simulations += found.simulations;
        if let Some(best) = found.optima.first() {
            nominal_point = figures(&best.point, DesignKind::Nominal)?;
            known.push(best.point.clone());
        }
    }
    (options.stage)("the optimum with tolerances");
    let found = found(question, axes, &known, REPORTED, options)?;
    simulations += found.simulations;
    confirming += found.confirming;
    let parameter = |(free, searched): (&crate::model::Free, &[f64; 2])| {
        let unit = question.model.parameters.iter().find(|own| own.name == free.name).map(|own| own.unit.clone());
        DesignParameter {
            name: free.name.clone(),
            unit: unit.unwrap_or_default(),
            display: question.model.parameter_units.get(&free.name).cloned(),
            range: [free.lower, free.upper],
            searched: *searched,
        }
    };
    (options.stage)("profiles");
    let profiles = profiles(question, &found.surface, &found.optima[0].point)?;
    let optima: Vec<DesignPoint> = found.optima.into_iter().map(|own| own.found).collect();
    Ok(DesignStudy {
        model: question.model.name.clone(),
        objective,
        criterion: question.share.map_or(Criterion::WorstCase, Criterion::Share),
        parameters: axes.free.iter().zip(&found.searched).map(parameter).collect(),
        not_met: optima.first().map(not_met).unwrap_or_default(),
        optima,
        model_point,
        nominal_point,
        allocation: None,
        profiles,
        simulations,
        confirming,
    })
}

/// Optima with their studies, the best first.
struct Found {
    /// At least one.
    optima: Vec<Studied>,
    /// That of the whole ranges, or of the part about the first known point that has one.
    surface: Surface,
    /// By free parameter, the part of its range that was searched.
    searched: Vec<[f64; 2]>,
    simulations: usize,
    confirming: usize,
}

impl Found {
    /// Whether an optimum is known that is as good as at a point.
    fn has(&self, axes: &Axes, point: &[f64]) -> bool {
        let ranges = axes.ranges();
        self.optima.iter().any(|other| are_alike(&ranges, &other.point, point))
    }

    /// Counts a surrogate.
    fn add(&mut self, surface: &Surface) {
        self.simulations += surface.simulations;
        for (searched, own) in self.searched.iter_mut().zip(&surface.region) {
            *searched = [searched[0].min(own[0]), searched[1].max(own[1])];
        }
    }
}

/// Searches the whole ranges, then about each of the best optima.
fn found(
    question: &Question,
    axes: &Axes,
    known: &[Vec<f64>],
    most: usize,
    options: &Options,
) -> Result<Found, DesignError> {
    let surface = Surface::new(question, axes, &axes.ranges(), &known[0], options)?;
    let rough = optima(question, &surface, known, options)?;
    let (searched, simulations) = (surface.region.clone(), surface.simulations);
    let mut all = Found { optima: Vec::new(), surface, searched, simulations, confirming: 0 };
    for own in rough {
        if all.optima.len() >= most || ((options.interrupted)() && !all.optima.is_empty()) {
            break;
        }
        // A search may have come to an optimum that is known by now.
        if all.has(axes, &own.point) {
            continue;
        }
        let Some(found) = refined(question, axes, &own, &mut all, options)? else { continue };
        all.optima.push(found);
    }
    if all.optima.is_empty() {
        return Err(DesignError::NoSurrogate);
    }
    all.optima.sort_by(|a, b| a.merit.order(&b.merit));
    Ok(all)
}
