//! Estimates of the outputs in a row: range, errors and sensitivity.

use super::composition::Row;
use super::range_search::{Previous, RangeSearch};
use super::sensitivity::SensitivityAnalysis;
use crate::methods::followed::Sensitivity;
use crate::methods::result::Estimate;
use crate::methods::validation::{HeldOut, ValidationTable};

/// Estimates ranges with their errors.
pub(super) struct RangeEstimator<'a> {
    pub search: &'a RangeSearch,
    pub validation: HeldOut<'a>,
    /// Samples of the whole box with the schedule's steps and with halved ones, if the time steps' errors are asked
    /// for.
    pub halved: Option<(&'a ValidationTable, &'a ValidationTable)>,
    pub sensitivity: Option<SensitivityAnalysis<'a>>,
}

impl RangeEstimator<'_> {
    /// Estimates of every output in a row, whose index among all is `index`.
    pub fn estimate(&self, row: &Row, index: usize, previous: &mut Previous) -> Vec<Estimate> {
        let found = row.range(self.search, previous);
        let errors = row.errors(self.search, self.validation, index, &found);
        let step_errors = match self.halved {
            Some((direct, halved)) => row.step_errors(self.search, direct, halved, index, &found),
            None => vec![f64::NAN; errors.len()],
        };
        let sensitivities: Vec<Option<Sensitivity>> = match &self.sensitivity {
            Some(analysis) => analysis.of_row(row, &found.extents).into_iter().map(Some).collect(),
            None => vec![None; errors.len()],
        };
        let estimate = |(output, sensitivity): (usize, Option<Sensitivity>)| {
            let extent = &found.extents[output];
            Estimate {
                range: extent.range,
                error: errors[output],
                of_search: row.of_search(output, extent),
                step_error: step_errors[output],
                sensitivity,
                is_expanded: found.expanded[output],
                is_own: found.own[output],
            }
        };
        sensitivities.into_iter().enumerate().map(estimate).collect()
    }
}
