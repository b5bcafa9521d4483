//! Results of methods.

use std::ops::Range as Rows;
use std::sync::Arc;

use super::ensemble::Simulated;
use super::followed::Sensitivity;
use super::kept::KeptSurrogate;
use super::tuning::TUNING;
use super::validation::Validation;
use crate::certificate::Certified;
use crate::numerics::{Range, largest, surrogate_error};

/// A method's bands of all outputs, their errors, and their cost.
#[derive(Clone, Debug, Default)]
pub struct MethodResult {
    /// Ranges by output and row.
    pub bands: Vec<Vec<Range>>,
    /// Intervals of the output since the row before, by output and row; empty if the method does not know them.
    pub between: Vec<Vec<Range>>,
    /// The surrogate's error, by output and row.
    pub surrogate: Vec<Vec<f64>>,
    /// Whether that error is known row by row at all samples, so that it says nothing of the rows behind.
    pub is_told_at_rows: bool,
    /// The time steps' error where the method knows it better than the validation samples' outputs do; else NaN.
    pub steps: Vec<Vec<f64>>,
    /// Sensitivities by output and row, if known.
    pub sensitivities: Vec<Vec<Option<Sensitivity>>>,
    /// Rows in which something is known.
    pub reached: usize,
    /// Reason why the bounds end early, if it is not a sample's stop.
    pub note: Option<String>,
    /// Number of simulations.
    pub simulations: usize,
    /// Highest degree in each parameter, if the tolerance decided it.
    pub order: Option<Vec<usize>>,
    /// Number of boxes into which the box was split, if the tolerance decided it.
    pub boxes: Option<usize>,
    /// Outputs that in some row do not follow from the coordinates and were expanded themselves.
    pub expanded: Vec<usize>,
    /// Outcome of the simulations.
    pub simulated: Simulated,
    /// The surrogate, if it is to be stored.
    pub kept: Option<KeptSurrogate>,
    /// The proof, if there is one.
    pub certified: Option<Arc<Certified>>,
}

/// Estimates of one output in one row.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The range.
    pub range: Range,
    /// Error of the surrogate.
    pub error: f64,
    /// The part of the error that no sample makes smaller: that of the search for the ends of an output that jumps.
    pub of_search: f64,
    /// Error of the time steps; NaN if not asked for.
    pub step_error: f64,
    /// Sensitivities, if they are asked for.
    pub sensitivity: Option<Sensitivity>,
    /// Whether the output does not follow from the coordinates there and was expanded itself.
    pub is_expanded: bool,
    /// Whether it is the polynomial through its own samples.
    pub is_own: bool,
}

/// An output's polynomial in a row: its range, how much too wide that may be, how large the terms are that it lacks, as
/// far as they are known, and its values at the validation samples.
pub(super) struct PolynomialEstimate {
    pub range: Range,
    pub excess: f64,
    pub truncation: f64,
    pub at_validation: Vec<f64>,
    /// Sensitivities, if known.
    pub sensitivity: Option<Sensitivity>,
    /// Coefficients of the polynomial, if they are to be stored.
    pub coefficients: Vec<f64>,
}

/// Collects a method's bands row by row.
#[derive(Debug)]
pub struct BandBuilder {
    bands: Vec<Vec<Range>>,
    surrogate: Vec<Vec<f64>>,
    steps: Vec<Vec<f64>>,
    sensitivities: Vec<Vec<Option<Sensitivity>>>,
    expanded: Vec<bool>,
}

impl BandBuilder {
    /// Bands of `outputs` outputs and `rows` rows, all unknown.
    pub fn new(outputs: usize, rows: usize) -> Self {
        Self {
            bands: vec![vec![Range::UNKNOWN; rows]; outputs],
            surrogate: vec![vec![f64::NAN; rows]; outputs],
            steps: vec![vec![f64::NAN; rows]; outputs],
            sensitivities: vec![vec![None; rows]; outputs],
            expanded: vec![false; outputs],
        }
    }

    /// Sets one output's range and surrogate error in one row.
    pub fn set(&mut self, row: usize, output: usize, range: Range, surrogate: f64) {
        self.bands[output][row] = range;
        self.surrogate[output][row] = surrogate;
    }

    /// Sets the sensitivity of one output in one row.
    pub fn set_sensitivity(&mut self, row: usize, output: usize, sensitivity: Option<Sensitivity>) {
        self.sensitivities[output][row] = sensitivity;
    }

    /// Sets all that is estimated of one output in one row.
    pub fn set_estimate(&mut self, row: usize, output: usize, estimate: Estimate) {
        self.set(row, output, estimate.range, estimate.error);
        self.steps[output][row] = estimate.step_error;
        self.set_sensitivity(row, output, estimate.sensitivity);
        self.expanded[output] |= estimate.is_expanded;
    }

    /// Sets ranges of polynomials, row by row, output by output; `kinks` says which outputs have kinks between
    /// validation samples.
    pub(super) fn set_polynomials(
        &mut self,
        rows: Rows<usize>,
        found: &mut [PolynomialEstimate],
        validation: &Validation,
        kinks: &[bool],
    ) {
        for (row, found) in rows.zip(found.chunks_exact_mut(self.bands.len())) {
            for (output, found) in found.iter_mut().enumerate() {
                let seen = surrogate_error(&found.at_validation, &validation.direct.at(row, output));
                let error = if kinks.get(output) == Some(&true) { TUNING.between_kinks * seen } else { seen };
                self.set(row, output, found.range, largest([error, found.truncation]) + found.excess);
                self.sensitivities[output][row] = found.sensitivity.take();
            }
        }
    }

    /// All rows but those that are missing, and the surrogate, if it is to be stored, with its errors.
    pub(super) fn finish_keeping(
        self,
        simulations: usize,
        simulated: Simulated,
        kept: Option<KeptSurrogate>,
    ) -> MethodResult {
        let result = self.finish(simulations, simulated);
        let kept = kept.map(|kept| kept.with_errors(result.surrogate.clone()));
        MethodResult { kept, ..result }
    }

    /// All rows but those that are missing.
    pub fn finish(mut self, simulations: usize, simulated: Simulated) -> MethodResult {
        let rows = self.bands.first().map_or(0, Vec::len);
        let reached = rows - simulated.missing.min(rows);
        self.bands.iter_mut().for_each(|ranges| ranges[reached..].fill(Range::UNKNOWN));
        self.surrogate.iter_mut().chain(&mut self.steps).for_each(|errors| errors[reached..].fill(f64::NAN));
        self.sensitivities.iter_mut().for_each(|sensitivities| sensitivities[reached..].fill(None));
        MethodResult {
            bands: self.bands,
            between: Vec::new(),
            surrogate: self.surrogate,
            is_told_at_rows: false,
            steps: self.steps,
            sensitivities: self.sensitivities,
            reached,
            note: None,
            simulations,
            order: None,
            boxes: None,
            expanded: (0..self.expanded.len()).filter(|&output| self.expanded[output]).collect(),
            simulated,
            kept: None,
            certified: None,
        }
    }
}
