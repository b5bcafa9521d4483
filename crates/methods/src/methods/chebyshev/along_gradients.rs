//! Ends that were followed along gradients as bounds, instead of a surrogate.

use super::adaptive::Goal;
use super::tuning::TUNING;
use crate::methods::ensemble::{Ensemble, Simulated};
use crate::methods::followed::{Followed, FollowedEnds};
use crate::methods::request::Keep;
use crate::methods::result::{BandBuilder, MethodResult};
use crate::numerics::SAFETY_OF_SURROGATE;

/// For more parameters a sparse grid is not tried where ends that were followed along gradients miss the tolerance: its
/// nodes and its own search for ends grow with a power of their number.
pub const MOST_ON_GRIDS: usize = TUNING.most_on_grids;

/// Followed ends, and which of them meet the tolerance.
pub(super) struct FollowedWithin<'f> {
    followed: &'f FollowedEnds,
    parameters: usize,
    outputs: usize,
    /// Whether each end meets it, in rows that count, by row and output.
    is_within: Vec<bool>,
    /// Whether all of them do.
    all: bool,
}

impl<'f> FollowedWithin<'f> {
    /// Compares the followed ends of an ensemble's outputs with a goal.
    pub fn new(followed: &'f FollowedEnds, goal: &Goal, ensemble: &dyn Ensemble) -> Self {
        let outputs = ensemble.outputs();
        let counts = |index: usize| index / outputs < goal.outputs[index % outputs].rows;
        let meets = |(index, found): (usize, &Followed)| {
            SAFETY_OF_SURROGATE * found.error <= goal.outputs[index % outputs].allowed
        };
        let meet: Vec<bool> = followed.ends().iter().enumerate().map(meets).collect();
        let all = (0..meet.len()).all(|index| meet[index] || !counts(index));
        let is_within = (0..meet.len()).map(|index| meet[index] && counts(index)).collect();
        Self { followed, parameters: ensemble.domain().dimension(), outputs, is_within, all }
    }

    /// Whether they are all bounds. A stored surrogate of the whole box is a grid if the parameters are few.
    pub fn are_bounds(&self, keep: Keep) -> bool {
        let are_many = self.parameters > MOST_ON_GRIDS;
        let has_kept = match keep {
            Keep::Nothing => true,
            Keep::WholeBox | Keep::Margins => are_many && self.followed.surrogate().is_some(),
            Keep::Statistics => self.followed.surrogate().is_some(),
        };
        has_kept && (are_many || self.all)
    }

    /// All of them as the result of a method. The simulations were counted where they were made.
    pub fn bounds(&self) -> MethodResult {
        let count = self.followed.ends().len();
        let mut result = BandBuilder::new(self.outputs, count / self.outputs.max(1)).finish(0, Simulated::default());
        (0..count).for_each(|index| self.put(index, &mut result));
        MethodResult { kept: self.followed.surrogate().cloned(), ..result }
    }

    /// Removes from a goal outputs of which they are the bounds, unless a surrogate of the whole box is to be stored.
    pub fn leave(&self, goal: &mut Goal, keep: Keep) {
        if matches!(keep, Keep::WholeBox | Keep::Margins) {
            return;
        }
        for (index, output) in goal.outputs.iter_mut().enumerate() {
            let is_open = |row: &usize| !self.is_within[row * self.outputs + index];
            output.rows = (0..output.rows).rev().find(is_open).map_or(0, |row| row + 1);
        }
    }

    /// Replaces bounds by ends that meet the tolerance or have a smaller error. A stored surrogate has its own errors.
    pub fn replace(&self, result: &mut MethodResult) {
        for (index, (found, is_within)) in self.followed.ends().iter().zip(&self.is_within).enumerate() {
            let (row, output) = (index / self.outputs, index % self.outputs);
            if row < result.reached && (*is_within || found.error < result.surrogate[output][row]) {
                self.put(index, result);
            }
        }
    }

    /// Puts the ends of an output in a row into a result.
    fn put(&self, index: usize, result: &mut MethodResult) {
        let (found, row, output) = (&self.followed.ends()[index], index / self.outputs, index % self.outputs);
        result.bands[output][row] = found.range;
        result.surrogate[output][row] = found.error;
        result.steps[output][row] = f64::NAN;
        result.sensitivities[output][row].clone_from(&found.sensitivity);
    }
}
