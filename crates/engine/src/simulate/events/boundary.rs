//! Surfaces in the box on which an event is just grazed.
//!
//! On the side without the event, its margin is the least value of the switch until the next event; on the other side,
//! the least value of the parabola on which the switch would go on. Both are zero on the surface and have the same
//! slope there, so that a polynomial locates it.

use rayon::prelude::*;

use super::path::Path;
use super::path_step::{Lost, PathStep};
use super::segments::{Boundary, Event, Word};
use super::tuning::TUNING;
use crate::numerics::LeastSquares;

/// The surfaces between words, each with the margins of its samples, which `margins` gives.
pub(super) fn boundaries(words: &[Word], margins: impl Fn(&Boundary) -> Vec<f64>) -> Option<Vec<(Boundary, Vec<f64>)>> {
    let mut found: Vec<(Boundary, Vec<f64>)> = Vec::new();
    for (a, word) in words.iter().enumerate() {
        for (b, other) in words.iter().enumerate().skip(a + 1) {
            let before = word.events.iter().zip(&other.events).take_while(|(own, other)| own == other).count();
            let is_known = |(boundary, _): &(Boundary, Vec<f64>)| {
                let both = [(a, b), (b, a)];
                both.iter().any(|(a, b)| boundary.met.contains(a) && boundary.missed.contains(b))
            };
            if found.iter().any(is_known) {
                continue;
            }
            let [own, others] = [word, other].map(|word| word.events.get(before).copied());
            let with = |event: Option<Event>| -> Vec<usize> {
                let has = |other: &Word| {
                    other.events[..before.min(other.events.len())] == word.events[..before]
                        && other.events.get(before).copied() == event
                };
                (0..words.len()).filter(|&index| has(&words[index])).collect()
            };
            let one_way = |met: Option<Event>, missed: Option<Event>| {
                let (samples, grazed_at) = ([0; 2], Vec::new());
                Some(Boundary { before, event: met?, met: with(met), missed: with(missed), samples, grazed_at })
            };
            let ways = [one_way(own, others), one_way(others, own)];
            // The event that is nearer to being grazed is.
            let near = |boundary: Boundary| {
                let margins = margins(&boundary);
                let size = margins.iter().fold(0.0, |size, margin| margin.abs().max(size));
                let least = margins.iter().filter(|margin| **margin > 0.0).copied().fold(f64::INFINITY, f64::min);
                (least / size, boundary, margins)
            };
            let nearest = ways.into_iter().flatten().map(near).filter(|(share, ..)| share.is_finite());
            let (_, boundary, margins) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
            found.push((boundary, margins));
        }
    }
    Some(found)
}

/// Margins of samples, each given with whether it meets the boundary's event; NaN where one cannot be followed.
pub(super) fn margins<'p>(
    boundary: &Boundary,
    samples: &[(usize, bool)],
    path: impl Fn(usize) -> Option<Path<'p>> + Sync,
    end: f64,
) -> Vec<f64> {
    let of = |&(sample, is_met): &(usize, bool)| {
        path(sample).and_then(|path| margin(path, boundary, is_met, end).ok()).unwrap_or(f64::NAN)
    };
    samples.par_iter().map(of).collect()
}

/// Margin of a sample up to a time: positive without the event.
fn margin(mut path: Path, boundary: &Boundary, is_met: bool, end: f64) -> Result<f64, Lost> {
    let switch = boundary.event.switch;
    let sign = if boundary.event.rises { -1.0 } else { 1.0 };
    let (mut met, mut least) = (0, f64::INFINITY);
    loop {
        let is_there = met == boundary.before;
        let step = path.step(if is_there && !is_met { end } else { f64::INFINITY })?;
        if is_there && is_met && step.event.is_some() {
            let [_, rate] = path.at_end(switch);
            let bend = path.bend(step, switch);
            let until = until_other(&mut path, step, switch, end)?;
            return Ok(of_parabola(sign * rate, sign * bend, until - step.end));
        }
        if is_there && !is_met {
            least = path.least(step, switch, sign).map_or(least, |(_, own)| least.min(own));
            if step.event.is_some() || step.end >= end {
                let [value, rate] = path.at_end(switch).map(|value| sign * value);
                return Ok(if rate < 0.0 || least.is_infinite() { least.min(value) } else { least });
            }
        }
        met += usize::from(step.event.is_some());
        path.go_on(step);
    }
}

/// When, after a step, an event of another switch follows, at most an end.
fn until_other(path: &mut Path, mut step: PathStep, switch: usize, end: f64) -> Result<f64, Lost> {
    while step.end < end {
        path.go_on(step);
        step = path.step(end)?;
        if let Some(event) = step.event {
            return Ok(if event.switch == switch { end } else { step.end });
        }
    }
    Ok(end)
}

/// Value of each ξ at which margins are zero while the others are nominal, by parabolas in each.
pub(super) fn grazed_at(xi: &[Vec<f64>], nominal: &[f64], margins: &[f64]) -> Vec<Option<f64>> {
    let k = nominal.len();
    let size = margins.iter().fold(0.0, |size, margin| margin.abs().max(size));
    let weights = margins.iter().map(|margin| (margin.abs() / size + TUNING.near_surface).recip()).collect();
    let terms = |xi: &[f64]| -> Vec<f64> {
        std::iter::once(1.0).chain(xi.iter().copied()).chain(xi.iter().map(|xi| xi * xi)).collect()
    };
    let all: Vec<Vec<f64>> = xi.iter().map(|xi| terms(xi)).collect();
    let fitted = LeastSquares::new(&all, weights).and_then(|squares| squares.fit(margins));
    let Some((coefficients, _)) = fitted else { return vec![None; k] };
    let here: f64 = terms(nominal).iter().zip(&coefficients).map(|(term, own)| term * own).sum();
    let along = |axis: usize| {
        let (slope, bend) = (coefficients[1 + axis], coefficients[1 + k + axis]);
        let rest = here - nominal[axis] * (slope + bend * nominal[axis]);
        let root = (slope * slope - 4.0 * bend * rest).sqrt();
        // Written so that neither cancels; of two in the box the nearer one.
        let q = -0.5 * (slope + root.copysign(slope));
        let roots = [q / bend, rest / q].into_iter().filter(|own| own.abs() <= 1.0);
        roots.min_by(|a, b| (a - nominal[axis]).abs().total_cmp(&(b - nominal[axis]).abs()))
    };
    (0..k).map(along).collect()
}

/// Least value of a parabola that begins at zero, up to a time.
fn of_parabola(rate: f64, bend: f64, room: f64) -> f64 {
    let vertex = -rate / bend;
    if bend > 0.0 && vertex < room { -rate * rate / (2.0 * bend) } else { room * (rate + 0.5 * bend * room) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −3 τ + τ²: least at 1.5; within 1 at its end.
    #[test]
    fn least_value_of_a_parabola_stays_within_its_span() {
        assert!((of_parabola(-3.0, 2.0, 9.0) + 2.25).abs() < 1e-15);
        assert!((of_parabola(-3.0, 2.0, 1.0) + 2.0).abs() < 1e-15);
    }

    /// 1 − x² − y/2 is zero at x = ±1/√2 where y = 1, and at y = 2 where x = 0, which is outside.
    #[test]
    fn grazed_surface_is_located_along_each_parameter() {
        let points = crate::numerics::spread(2, 20);
        let margins: Vec<f64> = points.iter().map(|xi| 1.0 - xi[0] * xi[0] - 0.5 * xi[1]).collect();
        let [along_x, along_y] = &grazed_at(&points, &[0.2, 1.0], &margins)[..] else { panic!() };
        assert!((along_x.unwrap() - 0.5_f64.sqrt()).abs() < 1e-9);
        assert_eq!(*along_y, None);
    }
}
