//! The cheapest tolerances at nominal values.

use symdiff::{Binary, Formula};

use super::axes::Axes;
use super::points::{StudiedPoint, studied};
use super::search;
use super::surface::{DesignSurface, scale};
use super::tuning::TUNING;
use super::{DesignError, Question};
use crate::applications::{AllocateError, AllocateOptions, allocate};
use crate::model::Description;
use crate::results::{Allocation, DesignKind};
use crate::study::Options;

/// Has the requirements leave this margin, as a share of their limits.
fn require_margin(model: &mut Description, margin: f64) {
    for own in &mut model.requirements {
        let less = Formula::number(margin * scale(own));
        own.slacks.iter_mut().for_each(|slack| *slack = slack.combined(Binary::Sub, &less));
    }
}

/// The cheapest tolerances at nominal values, as a study confirms them; `None` if none may change.
pub fn allocated(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    options: &Options,
) -> Result<Option<Allocation>, DesignError> {
    let asked = AllocateOptions { share: question.share, widest: TUNING.widest };
    let mut model = axes.at(&question.shown, &axes.with_present(point));
    require_margin(&mut model, question.goal.margin());
    model.requirements.truncate(question.required());
    match allocate(&model, asked, options) {
        Ok(allocation) => Ok(Some(allocation)),
        Err(AllocateError::Unsuitable(_)) => Ok(None),
        Err(AllocateError::Run(error)) => Err(error.into()),
    }
}

/// The study at nominal values with the cheapest tolerances there; with those of the point if none will do.
pub fn at_cost(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    kind: DesignKind,
    options: &Options,
) -> Result<Option<StudiedPoint>, DesignError> {
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
    surface: &DesignSurface,
    options: &Options,
) -> Result<Option<StudiedPoint>, DesignError> {
    let mut assessed = question.assessed(surface)?;
    // Tighter tolerances make up for the margin that a rounded point misses.
    let rounded = axes.rounded(&point).into_iter().map(|own| assessed.restored(own)).collect();
    let point = search::best_of(&mut *assessed, question.goal, rounded, point);
    at_cost(question, axes, &point, DesignKind::Optimum, options)
}
