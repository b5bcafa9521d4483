//! The share of what is made that fulfils a requirement over time.

use rayon::prelude::*;

use super::rows::Rows;
use crate::model::Requirement;
use crate::numerics::statistics::{REPLICATES, share_interval};
use crate::results::YieldSummary;

/// Evaluations of slacks that a requirement takes, at most.
const MOST: usize = 1 << 23;

/// Samples of a replicate where each costs a loop closure.
const FEW: usize = 1 << 10;

/// All requirements that are over time.
pub(super) fn all(rows: &Rows) -> Vec<YieldSummary> {
    let requirements = rows.description.requirements.iter();
    requirements.filter_map(|requirement| of_requirement(rows, requirement)).collect()
}

/// What one row says: each sample's smallest slack, how far it may be off, and the capabilities.
struct Slack {
    values: Vec<f64>,
    error: f64,
    cp: Option<f64>,
    cpk: f64,
}

fn of_requirement(rows: &Rows, requirement: &Requirement) -> Option<YieldSummary> {
    let (from, to) = requirement.times?;
    let times = rows.kept.times();
    let rounding = 1e-9 * times.last().copied().unwrap_or(0.0);
    let within: Vec<usize> =
        (0..times.len()).filter(|&row| times[row] >= from - rounding && times[row] <= to + rounding).collect();
    if within.is_empty() || requirement.places.is_empty() {
        return None;
    }
    let each = MOST / (within.len() * requirement.places.len() * REPLICATES);
    let by_closure = |row: &usize| requirement.places.iter().any(|&output| rows.needs_closure(*row, output));
    let most = if within.par_iter().any(by_closure) { FEW } else { usize::MAX };
    let fewer = rows.fewer(1 << each.clamp(1, most).ilog2());
    let slacks: Vec<Slack> = within.par_iter().map(|&row| slack(rows, requirement, row, fewer)).collect();
    let count = slacks.iter().map(|slack| slack.values.len()).min()?;
    let error = slacks.iter().map(|slack| slack.error).fold(0.0, f64::max);
    if slacks.iter().any(|slack| slack.values.len() != count || !slack.error.is_finite()) {
        return None;
    }
    let margin = |sample: usize| slacks.iter().map(|slack| slack.values[sample]).fold(f64::INFINITY, f64::min);
    let margins: Vec<f64> = (0..count).into_par_iter().map(margin).collect();
    let seen = |least: f64| margins.iter().filter(|margin| **margin >= least).count();
    let share = seen(0.0) as f64 / count as f64;
    // What the error may turn counts against it, and so does what lies outside of the surrogate.
    let lower = share_interval(seen(error), count)[0] * (1.0 - rows.laws.left_out());
    let upper = share_interval(seen(-error), count)[1];
    let worst = (0..slacks.len()).min_by(|&a, &b| slacks[a].cpk.total_cmp(&slacks[b].cpk))?;
    let ppm = |share: f64| 1e6 * (1.0 - share);
    Some(YieldSummary {
        requirement: requirement.name.clone(),
        share,
        interval: [lower, upper],
        ppm: ppm(share),
        ppm_interval: [ppm(upper), ppm(lower)],
        cp: slacks[worst].cp,
        cpk: slacks[worst].cpk,
        time: times[within[worst]],
        samples: count,
    })
}

fn slack(rows: &Rows, requirement: &Requirement, row: usize, fewer: usize) -> Slack {
    let mut found = Slack { values: Vec::new(), error: 0.0, cp: None, cpk: f64::INFINITY };
    let mut moments: Vec<(f64, f64)> = Vec::new();
    for &output in &requirement.places {
        let (values, error) = rows.all_values(row, output, fewer);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let deviation = (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)).sqrt();
        moments.push((mean, deviation));
        found.cpk = found.cpk.min(mean / (3.0 * deviation));
        found.error = if error > found.error || error.is_nan() { error } else { found.error };
        if found.values.is_empty() {
            found.values = values;
        } else {
            found.values.iter_mut().zip(values).for_each(|(least, value)| *least = least.min(value));
        }
    }
    if let [(above, deviation), (below, _)] = moments[..] {
        found.cp = Some((above + below) / (6.0 * deviation));
    }
    found
}
