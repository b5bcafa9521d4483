//! An optimum made sharper: by surrogates over narrower regions about it, and by the study that confirms it.

use super::allocated;
use super::axes::Axes;
use super::goal::Goal;
use super::points::{StudiedPoint, studied};
use super::search::{self, Optimum, local};
use super::surface::{DesignSurface, about};
use super::tuning::TUNING;
use super::{DesignError, Found, Question};
use crate::results::DesignKind;
use crate::study::Options;

/// The optimum near to a rough one, with its study; `None` if the mechanism cannot be run there, or
/// the optimum is known.
pub fn refined(
    question: &Question,
    axes: &Axes,
    rough: &Optimum,
    all: &mut Found,
    options: &Options,
) -> Result<Option<StudiedPoint>, DesignError> {
    let ranges = axes.ranges();
    let mut point = rough.point.clone();
    let mut last = None;
    for share in TUNING.regions {
        for _ in 0..TUNING.moves {
            let surface = DesignSurface::new(question, axes, &about(&point, &ranges, share), &point, options)?;
            all.add(&surface);
            point = local(&surface, &mut *question.assessed(&surface)?, question.goal, &point, TUNING.sharp_end).point;
            let is_inside = !is_at_edge(&point, &surface.region, &ranges);
            last = Some(surface);
            if is_inside || (options.interrupted)() {
                break;
            }
        }
    }
    match last.filter(|_| !all.has(axes, &point)) {
        Some(surface) if matches!(question.goal, Goal::Cost(_)) => {
            let found = allocated::confirmed(question, axes, point, &surface, options)?;
            all.simulations += found.as_ref().map_or(0, |found| found.of_surrogate);
            all.confirming += found.as_ref().map_or(0, |found| found.simulations);
            Ok(found)
        }
        Some(surface) => confirmed(question, axes, point, surface, all, options),
        None => Ok(None),
    }
}

/// The study at a point; if it does not confirm that requirements hold, at others that leave more of them.
fn confirmed(
    question: &Question,
    axes: &Axes,
    mut point: Vec<f64>,
    mut surface: DesignSurface,
    all: &mut Found,
    options: &Options,
) -> Result<Option<StudiedPoint>, DesignError> {
    let mut best: Option<StudiedPoint> = None;
    for _ in 0..TUNING.corrections {
        point = search::best_of(&mut *question.assessed(&surface)?, question.goal, axes.rounded(&point), point);
        let Some(found) = studied(question, axes, &point, DesignKind::Optimum, options)? else { break };
        all.simulations += found.of_surrogate;
        all.confirming += found.simulations;
        let is_feasible = found.found.is_feasible;
        let left = question.assessed(&surface)?.slacks(&point);
        for (requirement, known) in found.margins.iter().enumerate().filter(|(_, known)| known.is_finite()) {
            // The violation of a rounded point is held in reserve, too.
            let missed = (-known).max(0.0);
            surface.reserves[requirement] +=
                surface.scales[requirement] * left[requirement] - known + TUNING.reserved * missed;
        }
        let is_better = |best: &StudiedPoint| match is_feasible == best.found.is_feasible {
            true => found.merit.is_better(&best.merit),
            false => is_feasible,
        };
        if best.as_ref().is_none_or(is_better) {
            best = Some(found);
        }
        if is_feasible || (options.interrupted)() {
            break;
        }
        point = local(&surface, &mut *question.assessed(&surface)?, question.goal, &point, TUNING.sharp_end).point;
    }
    Ok(best)
}

/// Whether a point is at an end of a region where the range does not end.
fn is_at_edge(point: &[f64], region: &[[f64; 2]], ranges: &[[f64; 2]]) -> bool {
    point.iter().zip(region).zip(ranges).any(|((value, own), range)| {
        let edge = TUNING.edge * (own[1] - own[0]);
        (value - own[0] < edge && own[0] > range[0]) || (own[1] - value < edge && own[1] < range[1])
    })
}
