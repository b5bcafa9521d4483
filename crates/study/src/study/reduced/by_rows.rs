//! A requirement over the time by the bounds of its slacks in the rows.
//!
//! The least slack over the time and the box does not depend on which is taken first. Over the time first, it is one
//! number a motion, with a kink over the box wherever its instant jumps. Over the box first, it is the least of the
//! lower bounds in the rows, which have no such kink; only the slack between rows is estimated.

use super::part::MarginPart;
use super::tuning::TUNING;
use crate::model::Requirement;
use crate::results::Band;
use crate::study::bounding::{Bounded, bands};
use crate::study::problem::Study;

/// Bounds of a requirement's margin from the rows; `None` if they do not determine it, or if a simulated sample with a
/// margin of `simulated` contradicts them.
pub fn by_rows(study: &Study, own: &Requirement, rows: &Bounded, simulated: f64) -> Option<MarginPart> {
    let (from, to) = own.times.filter(|(from, to)| from < to)?;
    let schedule = &rows.plan.schedule;
    let span: Vec<usize> = (0..schedule.rows).filter(|&row| (from..=to).contains(&schedule.time(row))).collect();
    // The span begins and ends where there are rows, and a dip takes three.
    let [first, .., last] = *span.as_slice() else { return None };
    let end = to.min(schedule.time(schedule.rows - 1));
    let is_whole = schedule.time(first) == from && schedule.time(last) == end && span.len() > 2;
    let of_slack = |&index: &usize| {
        let bands = bands(study, rows, index, schedule.rows);
        let is_resolved = |band: &&Band| span.iter().all(|&row| !band.error.unresolved[row]);
        let is_known = |band: &&Band| span.iter().all(|&row| band.error.decisive(row).is_some());
        let band = bands.iter().find(is_resolved).or(bands.iter().find(is_known))?;
        let lower = &band.lower[first..=last];
        let dip =
            lower.windows(3).map(|l| TUNING.safety_of_dip / 8.0 * (l[0] - 2.0 * l[1] + l[2]).abs()).fold(0.0, f64::max);
        let reached = |row: usize| lower[row] - band.error.decisive(first + row).unwrap_or(f64::NAN);
        let least = (0..lower.len()).map(reached).fold(f64::INFINITY, f64::min) - dip;
        let lower = lower.iter().copied().fold(f64::INFINITY, f64::min);
        Some(MarginPart {
            lower,
            error: lower - least,
            surrogate: band.error.surrogate,
            time: band.error.time,
            is_known: true,
            method: band.method.name(),
        })
    };
    let parts: Vec<MarginPart> = own.outputs.iter().map(of_slack).collect::<Option<_>>()?;
    let part = parts.into_iter().min_by(|a, b| a.reached().total_cmp(&b.reached()))?;
    (is_whole && part.reached() <= simulated).then_some(part)
}
