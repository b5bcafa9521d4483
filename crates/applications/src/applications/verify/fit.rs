//! Functions through values at nodes, and polynomials near a nominal motion.

use std::collections::BTreeMap;

use symdiff::math;

use super::tuning::TUNING;
use crate::assemble::System;
use crate::numerics::ChebyshevSeries;

/// A nominal motion, row by row.
pub struct Nominal {
    /// s, from zero on.
    pub times: Vec<f64>,
    /// Positions, velocities and multipliers (2n + m) in each row.
    pub states: Vec<Vec<f64>>,
}

/// Series through values of several functions at nodes, without rounding; `None` if one is not resolved. Functions are
/// compared with the largest of their group: states may be of any size.
pub fn series(
    span: [f64; 2],
    values: &[Vec<f64>],
    resolved: f64,
    group: impl Fn(usize) -> usize,
) -> Option<Vec<ChebyshevSeries>> {
    let count = values.first().map_or(0, Vec::len);
    let mut found = Vec::with_capacity(count);
    let mut sizes = BTreeMap::new();
    for index in 0..count {
        let of_one: Vec<f64> = values.iter().map(|row| row[index]).collect();
        let own = ChebyshevSeries::through(span, &of_one);
        let size: &mut f64 = sizes.entry(group(index)).or_default();
        *size = size.max(own.size());
        found.push(own);
    }
    let is_resolved = |(index, own): (usize, &ChebyshevSeries)| own.tail() <= resolved * sizes[&group(index)];
    let all = found.iter().enumerate().all(is_resolved);
    let chopped =
        |(index, own): (usize, ChebyshevSeries)| own.chopped(TUNING.rounding_of_coefficients * sizes[&group(index)]);
    all.then(|| found.into_iter().enumerate().map(chopped).collect())
}

/// Values with a swing of their own where they hardly change.
fn moved(values: &mut [f64], index: usize, swing: f64) {
    let (least, most) = range(values);
    if most - least > swing {
        return;
    }
    let last = (values.len().max(2) - 1) as f64;
    for (row, value) in values.iter_mut().enumerate() {
        *value += swing * math::sin(index as f64 + (2.0 + 0.3 * index as f64) * row as f64 / last);
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &own| (least.min(own), most.max(own)))
}

/// Polynomials for q, v and λ over a time, with a swing as a share of scales; `None` if they are farther from the
/// motion than a share of its range, if there is one.
pub fn followed(
    nominal: &Nominal,
    span: [f64; 2],
    system: &System,
    swing: f64,
    near: Option<f64>,
) -> Option<Vec<ChebyshevSeries>> {
    let [first, last] = [span[0] * (1.0 - 1e-12), span[1] * (1.0 + 1e-12)];
    let rows = nominal.times.partition_point(|time| *time < first)..nominal.times.partition_point(|time| *time <= last);
    let (times, states) = (&nominal.times[rows.clone()], &nominal.states[rows]);
    let mut functions: Vec<Vec<f64>> =
        (0..states.first()?.len()).map(|index| states.iter().map(|state| state[index]).collect()).collect();
    let scales = system.coordinates.iter().map(|coordinate| coordinate.scale);
    functions
        .iter_mut()
        .zip(scales.clone())
        .enumerate()
        .for_each(|(index, (own, scale))| moved(own, index, swing * scale));
    let fit = ChebyshevSeries::fitted(span, TUNING.following_degree, times, &functions)?;
    let Some(near) = near else { return Some(fit) };
    let is_near = |((own, values), scale): ((&ChebyshevSeries, &Vec<f64>), f64)| {
        let (least, most) = range(values);
        let allowed = near * (most - least).max(1e-6 * scale);
        times.iter().zip(values).all(|(&time, value)| (own.at(time) - value).abs() <= allowed)
    };
    fit.iter().zip(&functions).zip(scales).all(is_near).then_some(fit)
}
