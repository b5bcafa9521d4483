//! Designs whose tolerances are chosen, too: allocated at each nominal point that is reported, and cost against margin.

use symdiff::{Binary, Formula};

use super::axes::Axes;
use super::goal::Goal;
use super::points::{Studied, studied};
use super::refine::refined;
use super::search::{self, ROUGH, local};
use super::surface::{Surface, scale};
use super::{DesignError, Found, Question, WIDEST, found};
use crate::model::Description;
use crate::results::{Allocation, DesignKind, DesignTrade, RequirementSummary};
use crate::study::{AllocateError, AllocateOptions, Options, allocate};

/// Shares of the largest margin without tolerances at which the cost is told.
const TRADED: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

/// The model whose requirements are to leave this margin, as a share of their limits.
fn with_margin(description: &Description, margin: f64) -> Description {
    let mut model = description.clone();
    for own in &mut model.requirements {
        let less = Formula::number(margin * scale(own));
        own.slacks.iter_mut().for_each(|slack| *slack = slack.combined(Binary::Sub, &less));
    }
    model
}

/// The cheapest tolerances at nominal values, as a study confirms them; `None` where none may change.
pub fn allocated(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    options: &Options,
) -> Result<Option<Allocation>, DesignError> {
    let asked = AllocateOptions { share: question.share, widest: WIDEST };
    let mut model = with_margin(&question.shown, question.goal.margin());
    model.requirements.truncate(question.required());
    match allocate(&axes.at(&model, &axes.with_present(point)), asked, options) {
        Ok(allocation) => Ok(Some(allocation)),
        Err(AllocateError::Unsuitable(_)) => Ok(None),
        Err(AllocateError::Run(error)) => Err(error.into()),
    }
}

/// The study at nominal values with the cheapest tolerances there; with those of the point where none will do.
pub fn at_cost(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    kind: DesignKind,
    options: &Options,
) -> Result<Option<Studied>, DesignError> {
    let allocation = allocated(question, axes, point, options)?;
    let met = allocation.as_ref().filter(|own| own.not_met.is_empty());
    let point = met.map_or_else(|| point.to_vec(), |own| axes.with_tolerances(point, &own.tolerances));
    let Some(mut found) = studied(question, axes, &point, kind, options)? else { return Ok(None) };
    if let Some(own) = &allocation {
        found.of_surrogate += own.simulations;
        found.simulations += own.confirming;
        // Its requirements are those with the margin.
        found.found.is_feasible &= own.is_confirmed;
    }
    found.allocation = allocation.filter(|own| own.not_met.is_empty());
    Ok(Some(found))
}

/// The same about a rough optimum, at rounded values.
pub fn confirmed(
    question: &Question,
    axes: &Axes,
    point: Vec<f64>,
    surface: &Surface,
    options: &Options,
) -> Result<Option<Studied>, DesignError> {
    let mut assessed = question.assessed(surface)?;
    // What a rounded point misses is made up for by tighter tolerances.
    let rounded = axes.rounded(&point).into_iter().map(|own| assessed.restored(own)).collect();
    let point = search::best_of(&mut *assessed, question.goal, rounded, point);
    at_cost(question, axes, &point, DesignKind::Optimum, options)
}

/// Cost against margin: the optimum, then those that leave shares of the largest margin there is without tolerances,
/// each near to the one before. It ends where no tolerances leave as much.
pub fn front(
    question: &Question,
    axes: &Axes,
    all: &mut Found,
    largest: f64,
    options: &Options,
) -> Result<Vec<DesignTrade>, DesignError> {
    let optima = std::mem::take(&mut all.optima);
    let front = beyond(question, axes, optima.first(), all, largest, options);
    all.optima = optima;
    front
}

fn beyond(
    question: &Question,
    axes: &Axes,
    first: Option<&Studied>,
    all: &mut Found,
    largest: f64,
    options: &Options,
) -> Result<Vec<DesignTrade>, DesignError> {
    let Some(first) = first.filter(|first| first.found.is_feasible) else { return Ok(Vec::new()) };
    let mut front: Vec<DesignTrade> = trade(first).into_iter().collect();
    let mut start = first.point.clone();
    for share in TRADED {
        if (options.interrupted)() || largest.is_nan() || largest <= 0.0 {
            break;
        }
        (options.stage)("cost against margin");
        let question = Question { goal: Goal::Cost(share * largest), ..question.clone() };
        let rough = local(&all.surface, &mut *question.assessed(&all.surface)?, question.goal, &start, ROUGH);
        let Some(found) = refined(&question, axes, &rough, all, options)? else { break };
        let Some(own) = Some(&found).filter(|found| found.found.is_feasible).and_then(trade) else { break };
        front.push(own);
        start = found.point;
    }
    Ok(front)
}

/// A point of the front.
fn trade(studied: &Studied) -> Option<DesignTrade> {
    let allocation = studied.allocation.as_ref()?;
    let found = &studied.found;
    let [margin, error] = studied.margin;
    Some(DesignTrade {
        margin,
        error,
        cost: found.worst,
        values: found.values.clone(),
        tolerances: allocation.tolerances.clone(),
        requirements: found.requirements.iter().map(RequirementSummary::clone).collect(),
        share: found.share,
    })
}

/// The same where the margin is the objective and tolerances have costs: from the cheapest near to its optimum on.
pub fn front_beside(
    question: &Question,
    point: &[f64],
    largest: f64,
    counts: &mut Found,
    options: &Options,
) -> Result<Vec<DesignTrade>, DesignError> {
    let question = Question { goal: Goal::Cost(0.0), is_least: true, ..question.clone() };
    let free = &counts.surface.axes.free;
    let axes = Axes::priced(&question.model, free, WIDEST);
    if axes.widths.is_empty() {
        return Ok(Vec::new());
    }
    (options.stage)("cost against margin");
    let mut all = match found(&question, &axes, &[axes.with_widths(point)], 1, options) {
        Err(DesignError::NoSurrogate) => return Ok(Vec::new()),
        found => found?,
    };
    let front = front(&question, &axes, &mut all, largest, options)?;
    counts.simulations += all.simulations;
    counts.confirming += all.confirming;
    Ok(front)
}
