//! Motions that are cut at events.

use std::sync::atomic::Ordering;

use super::Motions;
use crate::methods::Ensemble;
use crate::numerics::{STEP_NODES, Sample, CutMotions};
use crate::simulate::{SegmentRun, SimulationError};

/// Values of motions that are held at once, at most.
const MOST_VALUES: usize = 1 << 26;

impl Motions<'_> {
    /// As [`Ensemble::segments`].
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
    pub(super) fn cut(&self, samples: &[Sample]) -> Result<Option<CutMotions>, SimulationError> {
        let Some(segments) = self.schedule.segments() else { return Ok(None) };
        if STEP_NODES * segments.count() * 2 * self.scales().len() * samples.len() > MOST_VALUES {
            return Ok(None);
        }
        let run = SegmentRun::start(self.simulator, samples, segments, self.schedule.end())?;
        self.progress.advance(samples.len() * self.schedule.rows);
        self.over.fetch_add(samples.len(), Ordering::Relaxed);
        Ok(run.motions())
    }
}
