//! Questions that no method answers reliably.

use super::Status;
use crate::overview::unanswered;
use crate::results::{Bounds, OutputBounds, Summary};

/// Checks whether every question is answered: every output at every time by some method, every reduced output, and
/// every statistic.
pub(super) fn resolution(bounds: &Bounds, summary: &Summary) -> Status {
    // One reliable method is enough.
    let answered = |output: &OutputBounds| {
        let resolved = |row: usize| output.bands.iter().any(|band| !band.error.unresolved[row]);
        output.bands.is_empty() || (0..bounds.times.len()).all(resolved)
    };
    let is_answered = bounds.outputs.iter().all(answered) && unanswered(summary).is_empty();
    if is_answered { Status::Done } else { Status::Unresolved }
}
