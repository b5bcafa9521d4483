//! Validation samples: held out from every surrogate, simulated with the steps as they are and some with each step halved.

use super::ensemble::{Effort, Ensemble, EnsembleError, Observed, Sampling, Simulated, Until, lines};
use crate::numerics::{BandError, Range, largest, probes, time_error, validation};

/// Width of an output's range, relative to its values, that is rounding.
const ROUNDING: f64 = 1e-10;

/// All values of a few samples in all rows.
#[derive(Clone, Debug)]
pub struct ValidationTable {
    /// Lines of a row before the outputs': those of the motion, or none.
    motions: usize,
    outputs: usize,
    samples: usize,
    /// Row by row, line by line, sample by sample; rows that were not reached are missing.
    values: Vec<f64>,
}

impl ValidationTable {
    /// Simulates samples.
    ///
    /// # Errors
    /// Where one cannot be assembled.
    pub fn of(
        ensemble: &dyn Ensemble,
        samples: &[Vec<f64>],
        observed: Observed,
        finish: bool,
    ) -> Result<(Self, Simulated), EnsembleError> {
        let mut values = Vec::new();
        let sampling = Sampling { observed, until: Until::End, finish };
        let simulated = ensemble.simulate(samples, sampling, &mut |_, block| values.extend_from_slice(block))?;
        let outputs = ensemble.outputs();
        let motions = lines(ensemble, observed) - outputs;
        Ok((Self { motions, outputs, samples: samples.len(), values }, simulated))
    }

    /// One output's values in one row; NaN where it was not reached.
    pub fn at(&self, row: usize, output: usize) -> Vec<f64> {
        let first = (row * (self.motions + self.outputs) + self.motions + output) * self.samples;
        match self.values.get(first..first + self.samples) {
            Some(values) => values.to_vec(),
            None => vec![f64::NAN; self.samples],
        }
    }

    /// The samples' motions (line, sample) in one row that was reached, where they were observed.
    pub fn motion(&self, row: usize) -> &[f64] {
        let first = row * (self.motions + self.outputs) * self.samples;
        &self.values[first..][..self.motions * self.samples]
    }

    /// One line of the motions in one row that was reached.
    pub fn line(&self, row: usize, line: usize) -> &[f64] {
        &self.motion(row)[line * self.samples..][..self.samples]
    }

    /// Rows that were reached.
    pub fn rows(&self) -> usize {
        self.values.len() / ((self.motions + self.outputs) * self.samples)
    }

    /// Width of an output's range over all rows and samples; zero where that is less than `least`, or than rounding of the values.
    fn span(&self, output: usize, least: f64) -> f64 {
        let lines = self.values.chunks_exact(self.samples);
        let lines = lines.skip(self.motions + output).step_by(self.motions + self.outputs);
        let (lower, upper) = lines
            .flatten()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), &value| (lower.min(value), upper.max(value)));
        let least = least.max(ROUNDING * lower.abs().max(upper.abs()));
        if upper - lower <= least { 0.0 } else { (upper - lower).max(0.0) }
    }

    fn spans(&self, ensemble: &dyn Ensemble) -> Vec<f64> {
        (0..self.outputs).map(|output| self.span(output, ensemble.rounding(output))).collect()
    }
}

/// The validation samples of one box under one schedule.
#[derive(Debug)]
pub struct Validation {
    /// ξ of each.
    pub points: Vec<Vec<f64>>,
    /// With the schedule's steps.
    pub direct: ValidationTable,
    /// The first of them, with each step halved.
    pub halved: ValidationTable,
    /// Number of simulations.
    pub simulations: usize,
    /// What all of them took.
    pub effort: Effort,
    /// What came of those with the schedule's steps.
    pub simulated: Simulated,
    /// Width of each output's range over all rows and samples; zero where it is constant.
    pub spans: Vec<f64>,
}

impl Validation {
    /// Simulates them, for surrogates of this degree at most; `halved` is the ensemble with each step halved.
    ///
    /// # Errors
    /// Where one cannot be assembled.
    pub fn run(
        ensemble: &dyn Ensemble,
        halved: &dyn Ensemble,
        observed: Observed,
        degree: usize,
    ) -> Result<Self, EnsembleError> {
        let domain = ensemble.domain();
        let points = validation(domain.dimension(), degree);
        let first = probes(domain.dimension()).len();
        let samples = domain.points(&points);
        let (direct, simulated) = ValidationTable::of(ensemble, &samples, observed, false)?;
        let (halved, with_halved_steps) = ValidationTable::of(halved, &samples[..first], observed, false)?;
        let mut effort = simulated.effort;
        effort += with_halved_steps.effort;
        let simulations = points.len() + first;
        let spans = direct.spans(ensemble);
        Ok(Self { points, direct, halved, simulations, effort, simulated, spans })
    }

    /// Where nothing is uncertain: the nominal motion, of which so many rows are known, is the only sample, and is simulated with each
    /// step halved.
    ///
    /// # Errors
    /// Where it cannot be assembled.
    pub fn of_nominal(
        ensemble: &dyn Ensemble,
        halved: &dyn Ensemble,
        (nominal, reached): (&[Vec<Range>], usize),
    ) -> Result<Self, EnsembleError> {
        let points = validation(0, 0);
        let at = |row: usize| nominal.iter().map(move |ranges| ranges[row].lower);
        let values = (0..reached).flat_map(at).collect();
        let direct = ValidationTable { motions: 0, outputs: ensemble.outputs(), samples: points.len(), values };
        let samples = ensemble.domain().points(&points);
        let (halved, simulated) = ValidationTable::of(halved, &samples, Observed::Outputs, true)?;
        let simulations = points.len();
        let spans = direct.spans(ensemble);
        let effort = simulated.effort;
        Ok(Self { points, direct, halved, simulations, effort, simulated: Simulated::default(), spans })
    }

    /// The time steps' error of an output in each row, as if its range were that of the validation samples.
    pub fn time_error(&self, output: usize, rows: usize) -> Vec<f64> {
        let ranges: Vec<Range> = (0..rows).map(|row| Range::of(&self.direct.at(row, output))).collect();
        let of_row = |row: usize| time_error(ranges[row], &self.direct.at(row, output), &self.halved.at(row, output));
        let time: Vec<f64> = (0..rows).map(of_row).collect();
        BandError::new(&ranges, &vec![0.0; rows], &time, self.spans[output], None).total
    }

    /// The largest of the outputs' time errors, relative to what is allowed: a share of each output's range.
    pub fn worst_share(&self, allowed: f64, rows: usize) -> f64 {
        let share = |output: usize| {
            let span = self.spans[output];
            if span > 0.0 { largest(self.time_error(output, rows)) / (allowed * span) } else { 0.0 }
        };
        largest((0..self.spans.len()).map(share))
    }
}
