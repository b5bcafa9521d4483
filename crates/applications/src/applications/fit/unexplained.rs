//! Measured rows that no parameters explain.

use super::Measurements;
use super::local::Local;
use super::tuning::TUNING;
use crate::numerics::{LeastExcess, Tubes, least_excess};
use crate::results::Unexplained;

/// Compares single rows with polynomials over the model's box, `whole`, and all together with those about the least
/// squares.
pub fn unexplained(
    whole: &Local,
    local: &Local,
    measurements: &Measurements,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Unexplained {
    let excess = |tubes: &Tubes| least_excess(tubes, TUNING.tolerance_of_factor, TUNING.boxes_of_factor, interrupted);
    let mut alone: Vec<(usize, f64)> = Vec::new();
    for (index, &row) in whole.rows.iter().enumerate() {
        let own = excess(&only(&whole.tubes, index)).lower;
        if own > 0.0 {
            alone.push((row, own * measurements.values[row].noise));
        }
    }
    let relative = |own: &(usize, f64)| own.1 / measurements.values[own.0].noise;
    alone.sort_by(|a, b| relative(b).total_cmp(&relative(a)));
    let together = excess(&local.tubes);
    let worst = suspects(local, measurements, &together)
        .into_iter()
        .map(|index| (local.rows[index], 1.0 + excess(&without(&local.tubes, index)).upper))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    Unexplained { factor: 1.0 + together.upper.max(0.0), alone, worst }
}

/// Coefficients of one quantity.
fn size(tubes: &Tubes) -> usize {
    tubes.orders.iter().map(|order| order + 1).product()
}

/// One quantity.
fn only(tubes: &Tubes, index: usize) -> Tubes {
    let size = size(tubes);
    Tubes {
        orders: tubes.orders.clone(),
        coefficients: tubes.coefficients[index * size..][..size].to_vec(),
        outer: vec![tubes.outer[index]],
        inner: vec![tubes.inner[index]],
        scales: vec![tubes.scales[index]],
    }
}

/// Quantities that are the worst at the best parameters.
fn suspects(local: &Local, measurements: &Measurements, best: &LeastExcess) -> Vec<usize> {
    let values = local.at(std::slice::from_ref(&best.at));
    let excess = |index: usize| {
        let measured = &measurements.values[local.rows[index]];
        (values[index] - measured.value).abs() / measured.noise
    };
    let most = (0..local.rows.len()).map(excess).fold(0.0, f64::max);
    let mut suspects: Vec<usize> =
        (0..local.rows.len()).filter(|&index| excess(index) >= (1.0 - TUNING.as_bad) * most).collect();
    suspects.sort_by(|a, b| excess(*b).total_cmp(&excess(*a)));
    suspects.truncate(TUNING.left_out_rows);
    suspects
}

/// All quantities but one.
fn without(tubes: &Tubes, index: usize) -> Tubes {
    let size = size(tubes);
    let mut rest = tubes.clone();
    rest.coefficients.drain(index * size..(index + 1) * size);
    rest.outer.remove(index);
    rest.inner.remove(index);
    rest.scales.remove(index);
    rest
}
