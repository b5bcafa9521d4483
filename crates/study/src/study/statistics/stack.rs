//! A stack of dimensions: sensitivities about the nominal values, and a histogram.

use super::rows::Rows;
use super::tuning::TUNING;
use crate::model::{Analysis, Description};
use crate::numerics::statistics::REPLICATES;
use crate::results::{Histogram, Sensitivity};

/// Whether an output is asked for both: it closes a chain, or the model has dimensions alone.
pub(super) fn is_stack(description: &Description, output: &str) -> bool {
    description.analysis == Analysis::Dimensions || description.chains.iter().any(|chain| chain.output == output)
}

/// Sensitivities of an output to each parameter, the largest deviation first.
pub(super) fn sensitivities(rows: &Rows, row: usize, output: usize) -> Vec<Sensitivity> {
    let causes = rows.causes(row, output);
    let squares: f64 = causes.iter().map(|(.., deviation)| deviation * deviation).sum();
    let sensitivity = |(parameter, derivative, deviation): (String, f64, f64)| Sensitivity {
        parameter,
        derivative,
        deviation,
        share: if squares > 0.0 { deviation * deviation / squares } else { 0.0 },
    };
    let mut found: Vec<Sensitivity> = causes.into_iter().map(sensitivity).collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found
}

/// Histogram of the samples of an output; `None` if they are all the same, or unknown.
pub(super) fn histogram(rows: &Rows, row: usize, output: usize) -> Option<Histogram> {
    let is_own = rows.own_error(row, output, rows.kept.error(output).total[row]).is_some();
    let values = (0..REPLICATES).map(|replicate| rows.values(row, output, replicate, 1, is_own)).collect::<Vec<_>>();
    let values = values.concat();
    let (lower, upper) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    let width = (upper - lower) / TUNING.intervals as f64;
    // Written so that NaN has none.
    if !(width > 0.0 && width.is_finite()) {
        return None;
    }
    let mut shares = vec![0.0; TUNING.intervals];
    let share = 1.0 / values.len() as f64;
    for value in values {
        shares[(((value - lower) / width) as usize).min(TUNING.intervals - 1)] += share;
    }
    Some(Histogram { lower, upper, shares })
}
