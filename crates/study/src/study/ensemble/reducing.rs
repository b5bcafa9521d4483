//! Outputs of motions that are reduced to one number.

use super::Motions;
use crate::numerics::Sample;
use crate::study::reduced::steps_of;

/// Stores the numbers to which outputs of samples were reduced elsewhere.
pub(super) fn keep_reduced(motions: &Motions, samples: &[Sample], reduced: &[f64]) {
    if let Some(store) = motions.store.filter(|_| !reduced.is_empty()) {
        store.keep(steps_of(motions.schedule), samples, reduced);
    }
}
