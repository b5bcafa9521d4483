//! Motions at times between the rows.

use super::Motions;
use super::tuning::TUNING;
use crate::methods::DenseMotions;
use crate::numerics::Sample;
use crate::simulate::{Observed, Schedule, SimulationError, Steps, integrator};

/// As [`Ensemble::dense_motions`](crate::methods::Ensemble::dense_motions): of explicit steps, which determine the
/// motion inside them. None at an interruption.
///
/// # Errors
/// If a sample cannot be assembled.
pub fn dense(motions: &Motions, samples: &[Sample]) -> Result<Option<DenseMotions>, SimulationError> {
    if !motions.schedule.passes_rows() || motions.schedule.segments().is_some() {
        return Ok(None);
    }
    let (end, ends) = (motions.schedule.end(), motions.schedule.ends());
    let dense = Schedule::passing(end, end / (TUNING.times_a_step * ends.len()) as f64, ends, Vec::new())
        .taken(motions.schedule.integration);
    let mut run = integrator(motions.simulator, samples, &dense)?;
    run.heed(motions.interruption);
    let lines = 2 * motions.simulator.system.q.len() * samples.len();
    let stride = Observed::Motion.count(motions.simulator) * samples.len();
    let (mut motions, mut block) = (Vec::with_capacity(dense.rows * lines), Vec::new());
    for first in (0..dense.rows).step_by(TUNING.times_at_once) {
        let rows = first..(first + TUNING.times_at_once).min(dense.rows);
        run.advance(Steps { schedule: &dense, controller: None }, rows, Observed::Motion, &mut block);
        if run.is_cut() {
            return Ok(None);
        }
        block.chunks_exact(stride).for_each(|row| motions.extend_from_slice(&row[..lines]));
    }
    Ok(Some(((0..dense.rows).map(|row| dense.time(row)).collect(), motions)))
}
