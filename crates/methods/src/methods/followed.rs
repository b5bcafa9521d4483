//! Ends of outputs that were followed along gradients of the simulations themselves: bounds of many parameters, for
//! which a polynomial over the whole box would take too many samples.

use super::ensemble::Simulated;
use super::result::{BandBuilder, MethodResult, Sensitivity};
use crate::numerics::{Range, SAFETY_OF_SURROGATE};

/// An output's ends in one row.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Both are attained.
    pub range: Range,
    /// How far beyond them the output may go.
    pub error: f64,
    /// Where known.
    pub sensitivity: Option<Sensitivity>,
}

/// The ends of all outputs in all rows.
#[derive(Clone, Debug)]
pub struct FollowedEnds {
    outputs: usize,
    /// By row and output.
    ends: Vec<Followed>,
}

impl FollowedEnds {
    /// By row and output.
    pub fn new(outputs: usize, ends: Vec<Followed>) -> Self {
        Self { outputs, ends }
    }

    /// Whether the errors of the first `rows` rows, with their safety, are at most those `allowed` of each output. NaN
    /// is not.
    pub(super) fn meet(&self, allowed: &[f64], rows: usize) -> bool {
        let ends = self.ends.iter().zip(allowed.iter().cycle());
        ends.take(rows * self.outputs).all(|(found, allowed)| SAFETY_OF_SURROGATE * found.error <= *allowed)
    }

    /// As what a method finds. The simulations were counted where they were made.
    pub(super) fn result(&self) -> MethodResult {
        let mut bands = BandBuilder::new(self.outputs, self.ends.len() / self.outputs.max(1));
        for (place, found) in self.ends.iter().enumerate() {
            let (row, output) = (place / self.outputs, place % self.outputs);
            bands.set(row, output, found.range, found.error);
            bands.set_sensitivity(row, output, found.sensitivity.clone());
        }
        bands.finish(0, Simulated::default())
    }
}
