//! Bounds from climbs: the values that each end's climbs reached, and their errors.

use super::climb::Climb;
use super::surface::Surfaces;
use super::tuning::TUNING;
use super::{AttainedSearch, FollowedRow, best, by_end};
use crate::methods::{Followed, Sensitivity};
use crate::numerics::Range;

/// Uncertainty that climbs left at an end, or at both ends of an output in a row.
#[derive(Clone, Copy, Default)]
pub(super) struct Open {
    /// Gain that gradients there still promise.
    pub promise: f64,
    /// Distance by which second best climbs stayed behind the best.
    pub gap: f64,
}

/// Ends by row and output, from all climbs. Between the rows that are followed climbs are single: the gaps are those of
/// the followed rows before and after.
pub(super) fn ends(
    search: &AttainedSearch<'_, '_>,
    climbs: &mut [Climb],
    surfaces: Option<&Surfaces>,
    followed: &[FollowedRow],
) -> Vec<Followed> {
    let (rows, outputs) = (search.motions.rows(), search.motions.outputs());
    let mut open = vec![Open::default(); rows * outputs];
    for of_end in by_end(climbs) {
        let (end, left) = (of_end[0].end, open_of(search, of_end));
        let known = &mut open[end.row * outputs + end.output];
        *known = Open { promise: known.promise.max(left.promise), gap: known.gap.max(left.gap) };
    }
    let mut known = Vec::with_capacity(rows * outputs);
    for row in 0..rows {
        let before = followed.iter().map(|own| own.row).filter(|own| *own <= row).max();
        let after = followed.iter().map(|own| own.row).filter(|own| *own >= row).min();
        for output in 0..outputs {
            let Open { promise, gap } = open[row * outputs + output];
            let beside = before.iter().chain(&after).map(|row| open[row * outputs + output].gap);
            let least = TUNING.least_error * search.allowed[output];
            let error = (promise + beside.fold(gap, f64::max)).max(least);
            let range = search.attained.range(row, output).unwrap_or(Range::UNKNOWN);
            known.push(Followed { range, error, sensitivity: None });
        }
    }
    if let Some(surfaces) = surfaces {
        explain(search, &mut known, surfaces, followed);
    }
    known
}

/// Uncertainty that all climbs to one end left.
pub(super) fn open_of(search: &AttainedSearch<'_, '_>, of_end: &[Climb]) -> Open {
    let reached = search.best_sample(of_end[0].end).map_or(f64::INFINITY, |(value, _)| value);
    let known = of_end.iter().filter_map(|climb| climb.best.as_ref());
    let mut values: Vec<f64> = known.map(|known| known.value).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    Open {
        promise: best(of_end).map_or(f64::INFINITY, Climb::promise),
        gap: values.get(1).map_or(0.0, |second| reached - second),
    }
}

/// Adds the parameters' shares: those of the polynomials in rows that are followed, and between these of both.
fn explain(search: &AttainedSearch<'_, '_>, known: &mut [Followed], surfaces: &Surfaces, followed: &[FollowedRow]) {
    let outputs = search.motions.outputs();
    for FollowedRow { row, output, surface } in followed {
        let ends = search.attained.ends(*row, *output);
        let (Some(surface), [Some(lower), Some(upper)]) = (surface, ends) else { continue };
        let places = [lower, upper].map(|(_, sample)| search.study.domain.xi(sample));
        let own = &mut known[row * outputs + output];
        own.sensitivity = Some(surfaces.sensitivity(surface, own.range, places.each_ref().map(Vec::as_slice)));
    }
    for output in 0..outputs {
        let mut of_output: Vec<&mut Followed> = known.iter_mut().skip(output).step_by(outputs).collect();
        let explained: Vec<usize> = (0..of_output.len()).filter(|&row| of_output[row].sensitivity.is_some()).collect();
        for row in (0..of_output.len()).filter(|row| !explained.contains(row)) {
            let at = |row: &usize| Some((of_output[*row].sensitivity.as_ref()?, of_output[*row].range.width()));
            let before = explained.iter().rev().find(|own| **own < row);
            let after = explained.iter().find(|own| **own > row);
            let width = of_output[row].range.width();
            let between = match (before, after) {
                (Some(before), Some(after)) => {
                    let share = (row - before) as f64 / (after - before) as f64;
                    at(before).zip(at(after)).map(|(a, b)| mixed([a, b], [1.0 - share, share], width))
                }
                (one, other) => one.or(other).and_then(at).map(|own| mixed([own, own], [1.0, 0.0], width)),
            };
            of_output[row].sensitivity = between;
        }
    }
}

/// Shares of two rows, each with its width, in a row between them whose width is known.
fn mixed(ends: [(&Sensitivity, f64); 2], weights: [f64; 2], width: f64) -> Sensitivity {
    let [(a, width_a), (b, width_b)] = ends;
    let mix = |a: &[f64], b: &[f64], weights: [f64; 2]| {
        a.iter().zip(b).map(|(a, b)| weights[0] * a + weights[1] * b).collect::<Vec<f64>>()
    };
    let share = |weight: f64, own: f64| if own > 0.0 { weight * width / own } else { 0.0 };
    let by_width = [share(weights[0], width_a), share(weights[1], width_b)];
    Sensitivity {
        main: mix(&a.main, &b.main, weights),
        total: mix(&a.total, &b.total, weights),
        width_without: mix(&a.width_without, &b.width_without, by_width),
    }
}
