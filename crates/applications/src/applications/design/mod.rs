//! Nominal values that are best with the tolerances about them.
//!
//! Every candidate has its tolerances (`axes`). One run over the ranges and the tolerances about them gives a surrogate
//! of all margins (`surface`); on it, `worst` finds the least margins of a candidate in the worst case, and `search`
//! the local optima, in the order of `goal`. About each of these a surrogate over a narrower region makes the optimum
//! sharper (`refine`), and a study of its own determines its figures (`points`). The same without tolerances finds the
//! optimum that one would have chosen otherwise. If the cost is the objective, tolerances belong to the point (`width`,
//! `price`); they are those that allocation finds (`allocated`), and `front` has cost against margin.

mod allocated;
mod axes;
mod front;
mod goal;
mod instants;
mod points;
mod price;
mod profiles;
mod refine;
mod search;
mod share;
mod surface;
pub(crate) mod tuning;
mod width;
mod worst;

use std::ops::Range;

use crate::model::{Description, Objective};
use crate::results::{Criterion, DesignKind, DesignObjective, DesignParameter, DesignPoint, DesignStudy};
use crate::study::{Options, RunError, pool, reduced, statistics};
use crate::syntax::{Code, Coded};
use allocated::at_cost;
use axes::{Axes, without_tolerances};
use front::{front, front_beside};
use goal::Goal;
use instants::{at_instants, required};
use points::{StudiedPoint, not_met, studied};
use price::Priced;
use profiles::profiles;
use refine::refined;
use search::{are_alike, optima};
use share::Yield;
use surface::DesignSurface;
use tuning::TUNING;
use worst::{Assessed, WorstOfDesign};

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
#[derive(Clone)]
struct Question {
    /// The requested model, without the parts that its results do not need.
    shown: Description,
    /// With outputs for its requirements.
    model: Description,
    /// The same with requirements at instants, for the surrogates; and the indices of these for each requirement.
    at_instants: Description,
    instants: Vec<Range<usize>>,
    goal: Goal,
    /// Whether small values of the objective are good.
    is_least: bool,
    /// The share of the production that counts; every case if absent.
    share: Option<f64>,
}

impl Question {
    /// Number of the model's own requirements.
    fn required(&self) -> usize {
        self.model.requirements.len() - usize::from(self.goal == Goal::Last)
    }

    /// The same without tolerances.
    fn without_tolerances(&self) -> Self {
        let [shown, model, at_instants] = [&self.shown, &self.model, &self.at_instants].map(without_tolerances);
        // Without tolerances nothing costs: the largest margin leaves most to them.
        let goal = if let Goal::Cost(_) = self.goal { Goal::Margin } else { self.goal };
        Self { shown, model, at_instants, instants: self.instants.clone(), goal, share: None, ..*self }
    }

    /// Assessment of a candidate on a surrogate.
    fn assessed<'s>(&self, surface: &'s DesignSurface) -> Result<Box<dyn Assessed + 's>, DesignError> {
        let requirements: Box<dyn Assessed + 's> = match self.share.filter(|_| surface.axes.uncertain() > 0) {
            None => Box::new(WorstOfDesign::new(surface)),
            Some(share) => {
                let from = surface.axes.start();
                let laws = statistics::laws(&surface.axes.at(&self.model, &from)).map_err(DesignError::Unsuitable)?;
                Box::new(Yield::new(surface, self.goal, &laws, &from, share))
            }
        };
        Ok(match self.goal {
            Goal::Cost(_) => Box::new(Priced { requirements, axes: &surface.axes, goal: self.goal }),
            Goal::Margin | Goal::Last => requirements,
        })
    }
}

/// Options of a design study.
#[derive(Clone, Copy, Debug, Default)]
pub struct DesignOptions {
    /// The share of the production that fulfils all requirements and is at least as good as the objective's value;
    /// every case if absent.
    pub share: Option<f64>,
}

/// Finds the nominal values, within the ranges of the model's `design`, that are best in its `objective` with the
/// tolerances about them.
///
/// # Errors
/// If the model has no `design`, or cannot be run.
pub fn design(description: &Description, asked: DesignOptions, options: &Options) -> Result<DesignStudy, DesignError> {
    let Some(design) = &description.design else {
        let message = "the model has no `design`: name free parameters with their ranges, and an `objective`";
        return Err(DesignError::Unsuitable(message.to_owned()));
    };
    let mut model = description.clone();
    model.design = None;
    model.statistics.asked = false;
    let is_least = matches!(design.objective, Objective::Worst { is_largest: true, .. } | Objective::Cost);
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
        Objective::Margin | Objective::Cost => {
            let text = if is_least { "cost" } else { "margin" }.to_owned();
            DesignObjective { text, unit: String::new(), display: None, is_least }
        }
    };
    let pool = pool(options.threads);
    pool.map_err(RunError::from)?.install(|| {
        let shown = required(model);
        let (at_instants, instants) = at_instants(&shown);
        let [model, at_instants] = [&shown, &at_instants].map(|own| reduced::expanded(own).into_owned());
        let goal = Goal::of(design);
        let axes = match goal {
            Goal::Cost(_) => Axes::priced(&model, &design.free, TUNING.widest),
            Goal::Margin | Goal::Last => Axes::of(&model, &design.free),
        };
        if matches!(goal, Goal::Cost(_)) && axes.widths.is_empty() {
            let message = "no tolerance may change: all are `cost: fixed`, or have a distribution that does not follow the tolerance";
            return Err(DesignError::Unsuitable(message.to_owned()));
        }
        let question = Question { shown, model, at_instants, instants, goal, is_least, share: asked.share };
        designed(&question, &axes, objective, options)
    })
}

fn designed(
    question: &Question,
    axes: &Axes,
    objective: DesignObjective,
    options: &Options,
) -> Result<DesignStudy, DesignError> {
    let mut simulations = 0;
    let mut confirming = 0;
    let is_priced = matches!(question.goal, Goal::Cost(_));
    let mut figures = |point: &[f64], kind: DesignKind| -> Result<Option<DesignPoint>, DesignError> {
        let found = match is_priced && kind != DesignKind::Model {
            true => at_cost(question, axes, point, kind, options)?,
            false => studied(question, axes, point, kind, options)?,
        };
        confirming += found.as_ref().map_or(0, |found| found.simulations + found.of_surrogate);
        Ok(found.map(|found| found.found))
    };
    (options.stage)("the model's own values");
    let model_point = figures(&axes.present(), DesignKind::Model)?;
    let mut known = vec![axes.start()];
    let (mut nominal_point, mut largest) = (None, f64::NAN);
    if axes.uncertain() > 0 {
        (options.stage)("the optimum without tolerances");
        let bare = question.without_tolerances();
        let own = Axes::of(&bare.model, &axes.free);
        let found = found(&bare, &own, &known, 1, options)?;
        simulations += found.simulations;
        if let Some(best) = found.optima.first() {
            largest = best.merit.value;
            let point = axes.with_widths(&best.point);
            nominal_point = figures(&point, DesignKind::Nominal)?;
            known.push(point);
        }
    }
    (options.stage)("the optimum with tolerances");
    let mut found = found(question, axes, &known, TUNING.reported, options)?;
    let front = match question.goal {
        Goal::Cost(_) => front(question, axes, &mut found, largest, options)?,
        Goal::Margin => front_beside(question, &found.optima[0].point.clone(), largest, &mut found, options)?,
        Goal::Last => Vec::new(),
    };
    simulations += found.simulations;
    confirming += found.confirming;
    // The cheapest tolerances at the best point.
    let best = &mut found.optima[0];
    let allocation = match best.allocation.take() {
        None if best.found.is_feasible && question.shown.statistics.is_priced() => {
            allocated::allocated(question, axes, &best.point, options)?
        }
        own => own,
    };
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
        allocation,
        front,
        profiles,
        simulations,
        confirming,
    })
}

/// Optima with their studies, the best first.
struct Found {
    /// At least one.
    optima: Vec<StudiedPoint>,
    /// That of the whole ranges, or of the part about the first known point that has one.
    surface: DesignSurface,
    /// By free parameter, the part of its range that was searched.
    searched: Vec<[f64; 2]>,
    simulations: usize,
    confirming: usize,
}

impl Found {
    /// Whether an optimum is known that is as good as at a point.
    fn has(&self, axes: &Axes, point: &[f64]) -> bool {
        let ranges = axes.ranges();
        self.optima.iter().any(|other| are_alike(&ranges[..axes.free.len()], &other.point, point))
    }

    /// Counts a surrogate.
    fn add(&mut self, surface: &DesignSurface) {
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
    let surface = DesignSurface::new(question, axes, &axes.ranges(), &known[0], options)?;
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

impl Coded for DesignError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::Unsuitable(_) => Some(Code::Unsuitable),
            Self::NoSurrogate => Some(Code::Unanswerable),
            Self::Interrupted => None,
        }
    }
}
