//! Motions that are cut at events.

use std::sync::atomic::Ordering;

use symdiff::jet::JetSpace;

use super::Motions;
use super::tuning::TUNING;
use crate::methods::Ensemble;
use crate::numerics::{CutMotions, STEP_NODES, Sample, SegmentMotions};
use crate::simulate::{JetBox, SegmentRun, SimulationError, segment_jets};

/// As [`Ensemble::segments`].
///
/// # Errors
/// If a sample cannot be assembled.
pub fn cut(motions: &Motions, samples: &[Sample]) -> Result<Option<CutMotions>, SimulationError> {
    let Some(segments) = motions.schedule.segments() else { return Ok(None) };
    if STEP_NODES * segments.count() * 2 * motions.scales().len() * samples.len() > TUNING.most_values {
        return Ok(None);
    }
    let run = SegmentRun::start(motions.simulator, samples, segments, motions.schedule.end())?;
    motions.progress.advance(samples.len() * motions.schedule.rows);
    motions.over.fetch_add(samples.len(), Ordering::Relaxed);
    let (found, work) = run.motions();
    motions.iterations.fetch_add(work.iterations, Ordering::Relaxed);
    Ok(found)
}

/// As [`Ensemble::segment_jets`].
///
/// # Errors
/// If the sample cannot be assembled.
pub fn cut_jet(
    motions: &Motions,
    space: &JetSpace,
    xi: &[f64],
) -> Result<Option<(usize, SegmentMotions)>, SimulationError> {
    let Some(segments) = motions.schedule.segments() else { return Ok(None) };
    let center: Vec<f64> = motions.domain.sample(xi).iter().copied().collect();
    let half_width: Vec<f64> = (0..xi.len()).map(|parameter| motions.domain.half_width(parameter)).collect();
    let about = JetBox { center: &center, half_width: &half_width };
    segment_jets(motions.simulator, space, about, segments, motions.schedule.end())
}
