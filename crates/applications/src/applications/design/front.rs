//! Cost against margin.

use super::axes::Axes;
use super::goal::Goal;
use super::points::StudiedPoint;
use super::refine::refined;
use super::search::local;
use super::tuning::TUNING;
use super::{DesignError, Found, Question, found};
use crate::results::DesignTrade;
use crate::study::Options;

/// Cost against margin: the optimum, then those that leave shares of the largest margin there is without tolerances,
/// each near to the one before. It ends if no tolerances leave as much.
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
    first: Option<&StudiedPoint>,
    all: &mut Found,
    largest: f64,
    options: &Options,
) -> Result<Vec<DesignTrade>, DesignError> {
    let Some(first) = first.filter(|first| first.found.is_feasible) else { return Ok(Vec::new()) };
    let mut front: Vec<DesignTrade> = trade(first).into_iter().collect();
    let mut start = first.point.clone();
    for share in TUNING.traded {
        if (options.interrupted)() || largest.is_nan() || largest <= 0.0 {
            break;
        }
        (options.stage)("cost against margin");
        let question = Question { goal: Goal::Cost(share * largest), ..question.clone() };
        let rough =
            local(&all.surface, &mut *question.assessed(&all.surface)?, question.goal, &start, TUNING.rough_end);
        let Some(found) = refined(&question, axes, &rough, all, options)? else { break };
        let Some(own) = Some(&found).filter(|found| found.found.is_feasible).and_then(trade) else { break };
        front.push(own);
        start = found.point;
    }
    Ok(front)
}

/// A point of the front.
fn trade(studied: &StudiedPoint) -> Option<DesignTrade> {
    let allocation = studied.allocation.as_ref()?;
    let found = &studied.found;
    let [margin, error] = studied.margin;
    Some(DesignTrade {
        margin,
        error,
        cost: found.worst,
        values: found.values.clone(),
        tolerances: allocation.tolerances.clone(),
        requirements: found.requirements.clone(),
        share: found.share,
    })
}

/// The same with the margin as the objective and tolerances with costs: from the cheapest near to its optimum on.
pub fn front_beside(
    question: &Question,
    point: &[f64],
    largest: f64,
    counts: &mut Found,
    options: &Options,
) -> Result<Vec<DesignTrade>, DesignError> {
    let question = Question { goal: Goal::Cost(0.0), is_least: true, ..question.clone() };
    let free = &counts.surface.axes.free;
    let axes = Axes::priced(&question.model, free, TUNING.widest);
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
