//! The run of one jet under a schedule.

use std::ops::Range as Rows;
use std::sync::atomic::Ordering;

use symdiff::jet::JetSpace;

use super::tuning::TUNING;
use super::visits::visit_jets;
use super::{Motions, effort, stopped_at};
use crate::methods::{JET_WORK, Simulated};
use crate::simulate::{JetBox, Observed, SimulationError, jet_integrator};

/// As [`Ensemble::jets`](crate::methods::Ensemble::jets).
///
/// # Errors
/// If the middle of the box cannot be assembled.
pub fn jet_about_middle(
    motions: &Motions,
    space: &JetSpace,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    let parameters = 0..motions.domain.dimension();
    let center: Vec<f64> = parameters.clone().map(|parameter| motions.domain.midpoint(parameter)).collect();
    let half_widths: Vec<f64> = parameters.map(|parameter| motions.domain.half_width(parameter)).collect();
    if motions.simulator.system.analysis.visits() {
        return visit_jets(motions, space, &center.into(), &half_widths, reduce);
    }
    jet_about(motions, space, JetBox { center: &center, half_width: &half_widths }, reduce)
}

/// The same of a motion about any sample: coefficients of the outputs, row by row, in blocks.
///
/// # Errors
/// If the sample cannot be assembled.
pub fn jet_about(
    motions: &Motions,
    space: &JetSpace,
    about: JetBox,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    let mut jet = jet_integrator(motions.simulator, space, about, motions.schedule)?;
    jet.heed(motions.interruption);
    let (mut values, mut stop, mut next) = (Vec::new(), None, 0);
    while next < motions.schedule.rows && stop.is_none() {
        let rows = next..(next + TUNING.rows_of_jets).min(motions.schedule.rows);
        stop = jet.advance(motions.steps(), rows.clone(), Observed::Outputs, &mut values).into_iter().next();
        if jet.is_cut() {
            break;
        }
        let reached = stop.map_or(rows.end, |stop| stop.row);
        values.truncate(values.len() / rows.len() * (reached - rows.start));
        reduce(rows.clone(), &values);
        motions.progress.advance(JET_WORK * (space.monomials().order() + 1) * rows.len());
        next = rows.end;
    }
    if next == motions.schedule.rows || stop.is_some() {
        motions.over.fetch_add(1, Ordering::Relaxed);
    }
    let missing = motions.schedule.rows - stop.map_or(next, |stop| stop.row);
    let stop = stop.map(|stop| (stopped_at(&stop), about.center.to_vec().into()));
    Ok(Simulated { effort: effort(jet.counters()), stop, missing, ..Simulated::default() })
}
