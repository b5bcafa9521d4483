//! Local optima over a region: from several starts, each by linear programs within a trust region.
//!
//! The worst case over tolerances has kinks where it moves from corner to corner, but the slack of each case known so
//! far is a smooth function of the point. So the step is the one that makes the least of their linearisations largest,
//! and cases found at its end belong to the next one.

use super::goal::{Goal, Merit};
use super::surface::DesignSurface;
use super::tuning::TUNING;
use super::worst::Assessed;
use super::{DesignError, Question};
use crate::numerics::{Design, Linear, corners};
use crate::study::Options;

/// A point with its merit.
#[derive(Clone, Debug)]
pub struct Optimum {
    pub point: Vec<f64>,
    pub merit: Merit,
}

/// Local optima of a region, the best first; searches begin at `known` points and at some spread over it.
pub fn optima(
    question: &Question,
    surface: &DesignSurface,
    known: &[Vec<f64>],
    options: &Options,
) -> Result<Vec<Optimum>, DesignError> {
    let goal = question.goal;
    let mut found: Vec<Optimum> = Vec::new();
    for start in starts(surface, goal, known) {
        if (options.interrupted)() {
            return Err(DesignError::Interrupted);
        }
        let own = local(surface, &mut *question.assessed(surface)?, goal, &start, TUNING.rough_end);
        let nominal = &surface.region[..surface.axes.free.len()];
        match found.iter_mut().find(|other| are_alike(nominal, &other.point, &own.point)) {
            Some(other) if own.merit.is_better(&other.merit) => *other = own,
            Some(_) => {}
            None => found.push(own),
        }
    }
    found.sort_by(|a, b| a.merit.order(&b.merit));
    Ok(found)
}

/// The points to begin at: those known, and the best of those spread over the region that are apart.
fn starts(surface: &DesignSurface, goal: Goal, known: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let k = surface.region.len();
    let spread = Design::Sobol.points(
        k,
        (TUNING.starts_a_parameter * k).min(TUNING.most_starts),
        0..(TUNING.starts_a_parameter * k).min(TUNING.most_starts),
    );
    let in_region = |shares: &Vec<f64>| -> Vec<f64> {
        shares.iter().zip(&surface.region).map(|(share, [lower, upper])| lower + share * (upper - lower)).collect()
    };
    // A few cases show which are worth it.
    let cases: Vec<Vec<f64>> = corners(surface.axes.uncertain(), TUNING.corners_of_starts);
    let points: Vec<Vec<f64>> = spread.iter().map(in_region).collect();
    let samples: Vec<Vec<f64>> =
        points.iter().flat_map(|point| cases.iter().map(|xi| surface.axes.sample(point, xi))).collect();
    let slacks = surface.slacks(&samples);
    let own = |(index, point): (usize, Vec<f64>)| {
        let least = |requirement: usize| {
            let own = &slacks[requirement * samples.len() + index * cases.len()..][..cases.len()];
            own.iter().copied().fold(f64::INFINITY, f64::min)
        };
        let slacks = goal.counted(&surface.axes, &point, (0..surface.count()).map(least).collect());
        Optimum { merit: goal.merit(&slacks), point }
    };
    let mut all: Vec<Optimum> = points.into_iter().enumerate().map(own).collect();
    all.sort_by(|a, b| a.merit.order(&b.merit));
    let mut chosen = known.to_vec();
    for own in all {
        let distance = |other: &Vec<f64>| {
            let along = other.iter().zip(&own.point).zip(&surface.region);
            along.map(|((a, b), [lower, upper])| ((a - b) / (upper - lower)).abs()).fold(0.0, f64::max)
        };
        if chosen.len() < known.len() + TUNING.followed_starts
            && chosen.iter().all(|other| distance(other) > TUNING.first_radius)
        {
            chosen.push(own.point);
        }
    }
    chosen
}

/// Whether two optima of a region of nominal values are one.
pub fn are_alike(region: &[[f64; 2]], a: &[f64], b: &[f64]) -> bool {
    let along = a.iter().zip(b).zip(region);
    along.into_iter().all(|((a, b), [lower, upper])| (a - b).abs() <= TUNING.same_optimum * (upper - lower))
}

/// The optimum that a search from a start ends at, with steps down to the share `smallest` of the region.
pub fn local(
    surface: &DesignSurface,
    assessed: &mut dyn Assessed,
    goal: Goal,
    start: &[f64],
    smallest: f64,
) -> Optimum {
    let inside = |value: f64, [lower, upper]: &[f64; 2]| value.clamp(*lower, *upper);
    let point: Vec<f64> = start.iter().zip(&surface.region).map(|(value, ends)| inside(*value, ends)).collect();
    let mut best = Optimum { merit: goal.merit(&assessed.slacks(&point)), point };
    // Tolerances can always make up for a violation.
    let least_weight = if matches!(goal, Goal::Cost(_)) { f64::INFINITY } else { 0.0 };
    let (mut radius, mut weight, mut again) = (TUNING.first_radius, least_weight, 0);
    for _ in 0..TUNING.steps_of_search {
        // A step along limits leaves them by its square: violations have a price. At last nothing may be missed.
        if radius < smallest && (weight.is_infinite() || best.merit.violation == 0.0) {
            break;
        }
        if radius < smallest {
            (radius, weight) = (TUNING.restored * smallest, f64::INFINITY);
        }
        let [goals, limits] = goal.split(assessed.count(), assessed.linearised(&best.point));
        weight = weight.max(price(surface, &goals, &limits));
        let ends = |sign: f64| -> Vec<f64> {
            let along = best.point.iter().zip(&surface.region).enumerate();
            along.map(|(axis, (own, ends))| surface.axes.moved_by(axis, *own, sign * radius, *ends) - own).collect()
        };
        let (least, most) = (ends(-1.0), ends(1.0));
        let moved = |step: &[f64]| -> Vec<f64> { best.point.iter().zip(step).map(|(own, step)| own + step).collect() };
        let step = assessed.step(&best.point, &goals, &limits, [&least, &most]);
        let mut point = moved(&step);
        let mut merit = goal.merit(&assessed.slacks(&point));
        if !merit.is_better_by(&best.merit, weight) && merit.violation > best.merit.violation {
            let bent = bent(assessed, goal, &best.point, &step);
            let step = assessed.step(&best.point, &goals, &bent, [&least, &most]);
            point = assessed.restored(moved(&step));
            merit = goal.merit(&assessed.slacks(&point));
        }
        if merit.is_better_by(&best.merit, weight) {
            best = Optimum { point, merit };
            (radius, again) = ((TUNING.wider * radius).min(TUNING.largest_radius), 0);
        } else if assessed.has_learnt() && again < TUNING.tried_again {
            again += 1;
        } else {
            (radius, again) = (TUNING.narrower * radius, 0);
        }
    }
    best
}

/// Limits about a point with the values that they have at the end of a step, where they bend away from it (R. Fletcher,
/// Second order corrections for non-differentiable optimization, Lect. Notes Math. 912 (1982) 85).
fn bent(assessed: &mut dyn Assessed, goal: Goal, point: &[f64], step: &[f64]) -> Vec<Linear> {
    let end: Vec<f64> = point.iter().zip(step).map(|(own, step)| own + step).collect();
    let count = assessed.count();
    // The cases that are known are the same at both.
    let [here, there] = [point, &end].map(|at| goal.split(count, assessed.linearised(at)));
    let bent = |(here, there): (&Linear, &Linear)| {
        let along: f64 = here.slopes.iter().zip(step).map(|(slope, step)| slope * step).sum();
        Linear { value: there.value - along, slopes: here.slopes.clone() }
    };
    here[1].iter().zip(&there[1]).map(bent).collect()
}

/// The best of some points; `given` if there are none.
pub fn best_of(assessed: &mut dyn Assessed, goal: Goal, points: Vec<Vec<f64>>, given: Vec<f64>) -> Vec<f64> {
    let own = |point: Vec<f64>| Optimum { merit: goal.merit(&assessed.slacks(&point)), point };
    let best = points.into_iter().map(own).min_by(|a, b| a.merit.order(&b.merit));
    best.map_or(given, |best| best.point)
}

/// Least weight of a violation at which no goal is worth it: by the changes of the goals and of the nearest limit over
/// the region.
fn price(surface: &DesignSurface, goals: &[Linear], limits: &[Linear]) -> f64 {
    let change = |own: &Linear| {
        let along = own.slopes.iter().zip(&surface.region);
        along.map(|(slope, [lower, upper])| (slope * (upper - lower)).abs()).sum::<f64>()
    };
    let nearest = limits.iter().min_by(|a, b| a.value.total_cmp(&b.value)).map(change).filter(|change| *change > 0.0);
    nearest.map_or(0.0, |nearest| TUNING.price_of_violation * goals.iter().map(change).fold(0.0, f64::max) / nearest)
}
