//! Validation samples: held out from every surrogate, simulated with the steps as they are and some with each step
//! halved.

use super::ensemble::{Effort, Ensemble, EnsembleError, Observed, Sampling, Simulated, Until, lines};
use super::tuning::TUNING;
use crate::numerics::{
    BandError, Correction, Differences, Ledger, Range, Sample, TimeShift, Turning, corners_by_slopes, corrections,
    largest, step_validation, time_error, validation,
};

/// Samples of a box that a surrogate has not seen, with their values.
#[derive(Clone, Copy, Debug)]
pub struct HeldOut<'a> {
    /// ξ of the samples.
    pub points: &'a [Vec<f64>],
    /// Their motions and outputs, and nothing in rows that were not reached.
    pub direct: &'a ValidationTable,
}

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
    /// If one cannot be assembled.
    pub fn of(
        ensemble: &dyn Ensemble,
        samples: &[Sample],
        observed: Observed,
        whole: bool,
    ) -> Result<(Self, Simulated), EnsembleError> {
        let mut values = Vec::new();
        let sampling = Sampling { observed, until: Until::End, whole };
        let simulated = ensemble.simulate(samples, sampling, &mut |_, block| values.extend_from_slice(block))?;
        let outputs = ensemble.outputs();
        let motions = lines(ensemble, observed) - outputs;
        Ok((Self { motions, outputs, samples: samples.len(), values }, simulated))
    }

    /// These samples, followed by others, in the rows that both have reached.
    pub fn with(&self, others: &Self) -> Self {
        let lines = self.values.chunks_exact(self.samples).zip(others.values.chunks_exact(others.samples));
        let values = lines.flat_map(|(own, others)| own.iter().chain(others).copied()).collect();
        Self { samples: self.samples + others.samples, values, ..*self }
    }

    /// Some of the samples.
    pub fn pick(&self, indices: &[usize]) -> Self {
        let lines = self.values.chunks_exact(self.samples);
        let values = lines.flat_map(|line| indices.iter().map(|&index| line[index])).collect();
        Self { samples: indices.len(), values, ..*self }
    }

    /// One output's values in one row; NaN if it was not reached.
    pub fn at(&self, row: usize, output: usize) -> Vec<f64> {
        let first = (row * (self.motions + self.outputs) + self.motions + output) * self.samples;
        match self.values.get(first..first + self.samples) {
            Some(values) => values.to_vec(),
            None => vec![f64::NAN; self.samples],
        }
    }

    /// Values of all outputs (output, sample), row by row as far as rows were reached.
    pub fn of_outputs(&self) -> impl Iterator<Item = &[f64]> {
        let (motions, lines) = (self.motions * self.samples, (self.motions + self.outputs) * self.samples);
        self.values.chunks_exact(lines.max(1)).map(move |row| &row[motions..])
    }

    /// The samples' motions (line, sample) in one row that was reached, if they were observed.
    pub fn motion(&self, row: usize) -> &[f64] {
        let first = row * (self.motions + self.outputs) * self.samples;
        &self.values[first..][..self.motions * self.samples]
    }

    /// One line of the motions in one row that was reached.
    pub fn line(&self, row: usize, line: usize) -> &[f64] {
        &self.motion(row)[line * self.samples..][..self.samples]
    }

    /// The part of a coordinate's error, by the first of the samples with halved steps, that is a shift in time in this
    /// row; `None` if it is unknown.
    pub fn time_shift(&self, halved: &Self, row: usize, coordinate: usize) -> Option<TimeShift> {
        let velocity = self.motions / 2 + coordinate;
        let window = TimeShift::window(row, self.rows().min(halved.rows()));
        let at = |row: usize, sample: usize| Turning {
            direct: self.line(row, coordinate)[sample],
            halved: halved.line(row, coordinate)[sample],
            velocity: self.line(row, velocity)[sample],
        };
        TimeShift::of((0..halved.samples).map(|sample| window.clone().map(|row| at(row, sample)).collect()))
    }

    /// Corners that the outputs' slopes name in some row, where not all corners are among the samples, which begin with
    /// [`step_validation`].
    fn corners(&self, k: usize) -> Vec<Vec<f64>> {
        let all: Vec<usize> = (0..self.samples).collect();
        let spans: Vec<f64> = (0..self.outputs).map(|output| self.span(output, &all, 0.0)).collect();
        let lines = self.of_outputs().flat_map(|row| spans.iter().copied().zip(row.chunks_exact(self.samples)));
        corners_by_slopes(k, TUNING.corners_of_slopes, lines.filter(|(span, _)| *span > 0.0))
    }

    /// Rows that were reached.
    pub fn rows(&self) -> usize {
        self.values.len() / ((self.motions + self.outputs) * self.samples)
    }

    /// Width of an output's range over all rows and some samples; zero if that is less than `least`, or than
    /// rounding of the values.
    fn span(&self, output: usize, samples: &[usize], least: f64) -> f64 {
        let lines = self.values.chunks_exact(self.samples);
        let lines = lines.skip(self.motions + output).step_by(self.motions + self.outputs);
        let values = lines.flat_map(|line| samples.iter().map(|&sample| line[sample]));
        let (lower, upper) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), value| (lower.min(value), upper.max(value)));
        let least = least.max(TUNING.rounding_of_width * lower.abs().max(upper.abs()));
        if upper - lower <= least { 0.0 } else { (upper - lower).max(0.0) }
    }

    /// Spans of all outputs, given some samples with shorter steps; zero if an output is conserved: these remove
    /// most of its change.
    fn spans(&self, halved: &Self, odd: &OddSteps, ensemble: &dyn Ensemble) -> Vec<f64> {
        let first: Vec<usize> = (0..odd.table.samples).collect();
        let all: Vec<usize> = (0..self.samples).collect();
        let of = |output: usize| {
            let least = ensemble.rounding(output);
            let [own, finer] = [self, halved].map(|table| table.span(output, &odd.indices, least));
            let is_error = |finer: f64| finer < TUNING.conserved * own;
            if is_error(finer) && is_error(odd.table.span(output, &first, least)) {
                return 0.0;
            }
            self.span(output, &all, least)
        };
        (0..self.outputs).map(of).collect()
    }
}

/// A few of the samples, simulated with steps that are no multiple of the others and shorter than halved ones.
#[derive(Clone, Debug)]
pub struct OddSteps {
    /// Numbers of the samples.
    indices: Vec<usize>,
    table: ValidationTable,
    /// Length of these steps over that of the schedule's.
    ratio: f64,
}

/// The validation samples of one box under one schedule, and the same with other steps.
#[derive(Clone, Copy)]
pub struct Ensembles<'e> {
    /// The ensemble with the schedule's steps.
    pub direct: &'e dyn Ensemble,
    /// The ensemble with each step halved.
    pub halved: &'e dyn Ensemble,
    /// The ensemble with steps at odds with both,
    pub odd: &'e dyn Ensemble,
    /// and their length over that of the schedule's.
    pub ratio: f64,
    /// Whether all may be simulated at once: stored simulations are made one after the other.
    pub at_once: bool,
}

/// Samples with halved steps, and some of them with steps at odds with both.
struct Finer {
    halved: ValidationTable,
    simulated: Simulated,
    odd: OddSteps,
    of_odd: Effort,
}

impl Ensembles<'_> {
    /// Both results.
    fn both<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> Result<A, EnsembleError> + Send,
        second: impl FnOnce() -> Result<B, EnsembleError> + Send,
    ) -> Result<(A, B), EnsembleError> {
        if self.at_once {
            let (first, second) = rayon::join(first, second);
            return Ok((first?, second?));
        }
        Ok((first()?, second()?))
    }

    /// Simulates samples with finer steps.
    fn finer(&self, points: &[Vec<f64>], observed: Observed, whole: bool) -> Result<Finer, EnsembleError> {
        let samples = self.direct.domain().samples(points);
        let ((halved, simulated), (odd, of_odd)) = self.both(
            || ValidationTable::of(self.halved, &samples, observed, whole),
            || OddSteps::run(*self, points, whole),
        )?;
        Ok(Finer { halved, simulated, odd, of_odd })
    }
}

/// The validation samples of one box under one schedule.
#[derive(Clone, Debug)]
pub struct Validation {
    /// ξ of each.
    pub points: Vec<Vec<f64>>,
    /// Number of them that are spread over the box.
    pub spread: usize,
    /// Values with the schedule's steps.
    pub direct: ValidationTable,
    /// The first of them, with each step halved.
    pub halved: ValidationTable,
    /// A few of those with steps at odds with both.
    pub odd: OddSteps,
    /// Number of simulations.
    pub simulations: usize,
    /// Effort of all of them.
    pub effort: Effort,
    /// Outcome of those with the schedule's steps.
    pub simulated: Simulated,
    /// Width of each output's range over all rows and samples; zero if it is constant.
    pub spans: Vec<f64>,
}

impl OddSteps {
    /// Simulates the sample nearest to the middle of the box and two at opposite ends.
    fn run(ensembles: Ensembles, points: &[Vec<f64>], whole: bool) -> Result<(Self, Effort), EnsembleError> {
        let size = |index: &usize| points[*index].iter().map(|xi| xi.abs()).sum::<f64>();
        let sum = |index: &usize| points[*index].iter().sum::<f64>();
        let all = || 0..points.len();
        let mut indices: Vec<usize> = all().min_by(|a, b| size(a).total_cmp(&size(b))).into_iter().collect();
        indices.extend(all().min_by(|a, b| sum(a).total_cmp(&sum(b))));
        indices.extend(all().max_by(|a, b| sum(a).total_cmp(&sum(b))));
        indices.sort_unstable();
        indices.dedup();
        let chosen: Vec<Vec<f64>> = indices.iter().map(|&index| points[index].clone()).collect();
        let samples = ensembles.direct.domain().samples(&chosen);
        let (table, simulated) = ValidationTable::of(ensembles.odd, &samples, Observed::Outputs, whole)?;
        Ok((Self { indices, table, ratio: ensembles.ratio }, simulated.effort))
    }
}

impl Validation {
    /// Its samples with the schedule's steps.
    pub fn held_out(&self) -> HeldOut<'_> {
        HeldOut { points: &self.points, direct: &self.direct }
    }

    /// Simulates them, for surrogates of this degree at most; `ends` are further ξ at which halved steps count.
    /// They count at all samples if `halves_all`.
    ///
    /// # Errors
    /// If one cannot be assembled.
    pub fn run(
        ensembles: Ensembles,
        observed: Observed,
        degree: usize,
        ends: Vec<Vec<f64>>,
        halves_all: bool,
    ) -> Result<Self, EnsembleError> {
        let ensemble = ensembles.direct;
        let domain = ensemble.domain();
        let mut points = step_validation(domain.dimension());
        let spread_over_box = validation(domain.dimension(), degree).split_off(points.len());
        // Steps err most where parameters that act through one number are fastest, which may be in any corner.
        points.extend(ends);
        let few = points.len();
        let spread = spread_over_box.len();
        points.extend(spread_over_box);
        let first = if halves_all { points.len() } else { few };
        let samples = domain.samples(&points);
        let direct = || {
            let (mut direct, mut simulated) = ValidationTable::of(ensemble, &samples, observed, false)?;
            let corners = direct.corners(domain.dimension());
            if !corners.is_empty() {
                let (at_corners, others) = ValidationTable::of(ensemble, &domain.samples(&corners), observed, false)?;
                direct = direct.with(&at_corners);
                simulated.add(points.len(), others);
            }
            Ok((direct, simulated, corners))
        };
        let ((direct, simulated, corners), finer) =
            ensembles.both(direct, || ensembles.finer(&points[..first], observed, false))?;
        points.extend(corners);
        let Finer { halved, simulated: with_halved_steps, odd, of_odd } = finer;
        let mut effort = simulated.effort;
        effort += with_halved_steps.effort;
        effort += of_odd;
        let simulations = points.len() + first + odd.indices.len();
        let spans = direct.spans(&halved, &odd, ensemble);
        Ok(Self { points, spread, direct, halved, odd, simulations, effort, simulated, spans })
    }

    /// Validation if nothing is uncertain: the nominal motion, of which `reached` rows are known, is the only sample,
    /// and is simulated with each step halved.
    ///
    /// # Errors
    /// If it cannot be assembled.
    pub fn of_nominal(ensembles: Ensembles, nominal: &[Vec<Range>], reached: usize) -> Result<Self, EnsembleError> {
        let ensemble = ensembles.direct;
        let points = validation(0, 0);
        let at = |row: usize| nominal.iter().map(move |ranges| ranges[row].lower);
        let values = (0..reached).flat_map(at).collect();
        let direct = ValidationTable { motions: 0, outputs: ensemble.outputs(), samples: points.len(), values };
        let Finer { halved, simulated, odd, of_odd } = ensembles.finer(&points, Observed::Outputs, true)?;
        let simulations = points.len() + odd.indices.len();
        let spans = direct.spans(&halved, &odd, ensemble);
        let mut effort = simulated.effort;
        effort += of_odd;
        let simulated = Simulated::default();
        Ok(Self { points, spread: 0, direct, halved, odd, simulations, effort, simulated, spans })
    }

    /// The same samples at other ξ, over which they are not spread.
    pub fn at(&self, points: Vec<Vec<f64>>) -> Self {
        Self { points, spread: 0, ..self.clone() }
    }

    /// Notes the samples' values simulated with the schedule's steps.
    pub fn note(&self, ledger: &Ledger) {
        let ValidationTable { motions, outputs, samples, values } = &self.direct;
        ledger.note(0, motions + outputs, *samples, values);
    }

    /// Corrections of the error by halving in each row, since three steps do not agree at order 2, or since from some
    /// row on the equations switch inside steps.
    pub fn corrections(&self, output: usize, rows: usize, switched_from: Option<usize>) -> Vec<Correction> {
        let of_row = |row: usize| {
            let (direct, halved) = (self.direct.at(row, output), self.halved.at(row, output));
            let odd = self.odd.table.at(row, output);
            let mut found = Differences::default();
            for (&index, odd) in self.odd.indices.iter().zip(odd) {
                let (direct, halved) = (direct[index], halved[index]);
                found.halved = largest([found.halved, halved - direct]);
                found.finer = largest([found.finer, odd - halved]);
                found.all = largest([found.all, odd - direct]);
            }
            found
        };
        corrections(&(0..rows).map(of_row).collect::<Vec<Differences>>(), self.odd.ratio, switched_from)
    }

    /// The time steps' error of an output in each row, as if its range were that of the validation samples.
    pub fn time_error(&self, output: usize, rows: usize) -> Vec<f64> {
        let ranges: Vec<Range> = (0..rows).map(|row| Range::of(&self.direct.at(row, output))).collect();
        let corrections = self.corrections(output, rows, None);
        let of_row = |row: usize| {
            let error = time_error(ranges[row], &self.direct.at(row, output), &self.halved.at(row, output));
            corrections[row].of(error)
        };
        let time: Vec<f64> = (0..rows).map(of_row).collect();
        BandError::new(&ranges, &vec![0.0; rows], &time, self.spans[output], None).total
    }

    /// The largest of the outputs' time errors, relative to the allowed error: a share of each output's range.
    pub fn worst_share(&self, allowed: f64, rows: usize) -> f64 {
        let share = |output: usize| {
            let span = self.spans[output];
            if span > 0.0 { largest(self.time_error(output, rows)) / (allowed * span) } else { 0.0 }
        };
        largest((0..self.spans.len()).map(share))
    }
}
