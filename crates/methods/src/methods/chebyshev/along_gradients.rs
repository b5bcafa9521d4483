//! Ends that were followed along gradients as bounds, in place of a surrogate.

use super::tuning::TUNING;
use crate::methods::ensemble::Simulated;
use crate::methods::followed::{Followed, FollowedEnds};
use crate::methods::result::{BandBuilder, MethodResult};

/// For more parameters a sparse grid is not tried where ends that were followed along gradients miss the tolerance: its
/// nodes and its own search for ends grow with a power of their number.
pub const MOST_ON_GRIDS: usize = TUNING.most_on_grids;

/// Whether they are the bounds of a study with so many parameters, which may keep a surrogate: that is one of the whole
/// box, and of few parameters a grid has the smaller error. `is_within`: whether the ends of a row meet the tolerance.
pub(super) fn are_bounds(
    followed: &FollowedEnds,
    parameters: usize,
    keeps: bool,
    is_within: impl FnMut((usize, &[Followed])) -> bool,
) -> bool {
    let are_many = parameters > MOST_ON_GRIDS;
    let has_kept = !keeps || are_many && followed.surrogate().is_some();
    has_kept && (are_many || followed.rows().enumerate().all(is_within))
}

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
