//! Ends that were followed along gradients as bounds, in place of a surrogate.

use crate::methods::ensemble::Simulated;
use crate::methods::followed::FollowedEnds;
use crate::methods::result::{BandBuilder, MethodResult};

/// As what a method finds, of so many outputs and rows. The simulations were counted where they were made.
pub(super) fn bounds(followed: &FollowedEnds, outputs: usize, rows: usize) -> MethodResult {
    let mut bands = BandBuilder::new(outputs, rows);
    for (index, found) in followed.ends().iter().enumerate() {
        let (row, output) = (index / outputs, index % outputs);
        bands.set(row, output, found.range, found.error);
        bands.set_sensitivity(row, output, found.sensitivity.clone());
    }
    MethodResult { kept: followed.surrogate().cloned(), ..bands.finish(0, Simulated::default()) }
}
