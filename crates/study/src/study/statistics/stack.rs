//! A stack of dimensions: sensitivities about the nominal values, and a histogram.

use super::rows::Rows;
use crate::model::{Analysis, Description, Zone, ZoneShape};
use crate::numerics::statistics::REPLICATES;
use crate::results::{Histogram, Sensitivity};

/// Intervals of a histogram.
const INTERVALS: usize = 60;

/// Whether an output is asked for both: it closes a chain, or the model has dimensions alone.
pub(super) fn is_stack(description: &Description, output: &str) -> bool {
    description.analysis == Analysis::Dimensions || description.chains.iter().any(|chain| chain.output == output)
}

/// How an output follows each parameter, the largest deviation first.
pub(super) fn sensitivities(rows: &Rows, row: usize, output: usize) -> Vec<Sensitivity> {
    let causes = causes(rows, row, output);
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

/// Causes by name, with derivative and deviation about the nominal values. A zone is one: its deviation is the largest
/// of a linear output in it, the gradient's length times the radius of a disc or a ball.
pub(super) fn causes(rows: &Rows, row: usize, output: usize) -> Vec<(String, f64, f64)> {
    let zones = &rows.description.zones;
    let names = &rows.laws.names;
    let derivatives = rows.derivatives(row, output, &rows.laws.nominal);
    let is_member = |name: &String| zones.iter().any(|zone| zone.members.contains(name));
    let alone = names.iter().zip(&derivatives).filter(|(name, _)| !is_member(name));
    let alone = alone.map(|(name, &(derivative, deviation))| (name.clone(), derivative, deviation));
    let of_zone = |zone: &Zone| {
        let index = |member: &String| names.iter().position(|name| name == member);
        let members: Vec<usize> = zone.members.iter().filter_map(index).collect();
        // Along the radius, with the angles at these quarter turns.
        let along = |members: &[usize], angles: &[f64]| {
            let mut at = rows.laws.nominal.clone();
            members[1..].iter().zip(angles).for_each(|(&member, angle)| at[member] = *angle);
            rows.derivatives(row, output, &at)[members[0]].1
        };
        let length = |members: &[usize]| {
            let axes: &[[f64; 2]] = &[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
            let axes = if members.len() == 2 { &[[0.0; 2], [1.0; 2]] } else { axes };
            axes.iter().map(|angles| along(members, angles).powi(2)).sum::<f64>().sqrt()
        };
        let deviation = match zone.shape {
            ZoneShape::Box => members.iter().map(|&member| derivatives[member].1.abs()).sum(),
            ZoneShape::Discs => members.chunks_exact(2).map(length).sum(),
            ZoneShape::Ball => length(&members),
        };
        (zone.name.clone(), deviation, deviation)
    };
    alone.chain(zones.iter().map(of_zone)).collect()
}

/// How the samples of an output are distributed; `None` where they are all the same, or unknown.
pub(super) fn histogram(rows: &Rows, row: usize, output: usize) -> Option<Histogram> {
    let is_own = rows.own_error(row, output, rows.kept.error(output).total[row]).is_some();
    let values: Vec<f64> =
        (0..REPLICATES).flat_map(|replicate| rows.values(row, output, (replicate, 1), is_own)).collect();
    let (lower, upper) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    let width = (upper - lower) / INTERVALS as f64;
    // Written so that NaN has none.
    if !(width > 0.0 && width.is_finite()) {
        return None;
    }
    let mut shares = vec![0.0; INTERVALS];
    let share = 1.0 / values.len() as f64;
    for value in values {
        shares[(((value - lower) / width) as usize).min(INTERVALS - 1)] += share;
    }
    Some(Histogram { lower, upper, shares })
}
