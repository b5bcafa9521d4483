//! The probes: samples that no surrogate is made from, simulated with the steps as they are and some with each halved.

use super::methods::{FleetRun, Outcome, Run, Until};
use crate::numerics::{BandError, Range, largest, probes, time_error, validation};
use crate::results::MethodSummary;
use crate::simulate::{Counters, Observed, Schedule, SimulationError};

/// A table of the values of all outputs at all rows, of a few samples.
#[derive(Clone)]
pub(super) struct Table {
    /// Lines a row before the outputs': those of the motions, or none.
    motions: usize,
    outputs: usize,
    samples: usize,
    /// Row by row, line by line, sample by sample; rows that were not reached are missing.
    values: Vec<f64>,
}

impl Table {
    /// Simulates samples with a run's schedule.
    pub fn of(run: &Run, samples: &[Vec<f64>], observed: Observed) -> Result<(Self, FleetRun), SimulationError> {
        let mut values = Vec::new();
        let done = run.fleet(samples, observed, Until::End, |_, block| values.extend_from_slice(block))?;
        let outputs = run.outputs();
        let motions = observed.count(&run.study.simulator) - outputs;
        Ok((Self { motions, outputs, samples: samples.len(), values }, done))
    }

    /// One output's values in one row; not numbers where it was not reached.
    pub fn at(&self, row: usize, output: usize) -> Vec<f64> {
        let first = (row * (self.motions + self.outputs) + self.motions + output) * self.samples;
        match self.values.get(first..first + self.samples) {
            Some(values) => values.to_vec(),
            None => vec![f64::NAN; self.samples],
        }
    }

    /// The samples' motions in one row that was reached, where they were observed: line by line.
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

    /// Largest less least value of an output in all rows and samples; zero where that is less than `least`.
    fn span(&self, output: usize, least: f64) -> f64 {
        let lines = self.values.chunks_exact(self.samples);
        let lines = lines.skip(self.motions + output).step_by(self.motions + self.outputs);
        let (lower, upper) = lines
            .flatten()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), &value| (lower.min(value), upper.max(value)));
        if upper - lower < least { 0.0 } else { (upper - lower).max(0.0) }
    }

    /// That of every output, with the least that is told from rounding.
    fn spans(&self, run: &Run) -> Vec<f64> {
        let system = &run.study.simulator.system;
        let duration = run.schedule.output_step * run.schedule.rows as f64;
        let least = |unit: &str| least_range(unit, system.length, duration);
        system.outputs.iter().enumerate().map(|(index, output)| self.span(index, least(&output.unit))).collect()
    }
}

/// The probes of one box under one schedule.
pub(super) struct Probes {
    /// ξ of each.
    pub points: Vec<Vec<f64>>,
    /// With the schedule's steps.
    pub direct: Table,
    /// The first of them, with each step halved.
    pub halved: Table,
    /// What they took.
    pub solves: usize,
    pub done: FleetRun,
    pub summary: MethodSummary,
    /// How far each output ranges at all, in all rows and samples; zero where it is at rest.
    pub spans: Vec<f64>,
}

/// What ranges less, relative to the model's size and the run's duration, is at rest: Newton's iteration ends at 1e-12 or so.
const AT_REST: f64 = 1e-10;

/// The least range of an output that is told from rounding; zero for what has no size of its own, as a force.
fn least_range(unit: &str, length: f64, duration: f64) -> f64 {
    AT_REST
        * match unit {
            "rad" => 1.0,
            "m" => length,
            "rad/s" => 1.0 / duration,
            "m/s" => length / duration,
            _ => 0.0,
        }
}

impl Probes {
    /// Simulates them; `observed` is what is kept of them.
    ///
    /// # Errors
    /// Where one cannot be assembled.
    pub fn run(run: &Run, observed: Observed) -> Result<Self, SimulationError> {
        let begun = std::time::Instant::now();
        let domain = &run.study.domain;
        let points = validation(domain.dimension());
        let halved = probes(domain.dimension()).len();
        let samples = domain.points(&points);
        let (direct, done) = Table::of(run, &samples, observed)?;
        let schedule: Schedule = run.schedule.refined(2);
        let finer = Run { schedule: &schedule, tolerance: None, ..*run };
        let (fine, finely) = Table::of(&finer, &samples[..halved], observed)?;
        let counters = Counters {
            iterations: done.counters.iterations + finely.counters.iterations,
            rank_revealing: done.counters.rank_revealing + finely.counters.rank_revealing,
        };
        let solves = points.len() + halved;
        let summary = run.method_summary("probes", solves, counters, done.stop_place(), begun);
        let spans = direct.spans(run);
        Ok(Self { points, direct, halved: fine, solves, done, summary, spans })
    }

    /// Where nothing is uncertain the one course is the only probe; it is simulated with each step halved.
    ///
    /// # Errors
    /// Where it cannot be assembled.
    pub fn of_course(run: &Run, course: &Outcome) -> Result<Self, SimulationError> {
        let begun = std::time::Instant::now();
        let points = validation(0);
        let at = |row: usize| course.bands.iter().map(move |ranges| ranges[row].lower);
        let values = (0..course.reached).flat_map(at).collect();
        let direct = Table { motions: 0, outputs: run.outputs(), samples: points.len(), values };
        let schedule: Schedule = run.schedule.refined(2);
        let finer = Run { schedule: &schedule, tolerance: None, ..*run };
        let (halved, done) = Table::of(&finer, &run.study.domain.points(&points), Observed::Outputs)?;
        let stop = course.stop.as_ref().map(|(stop, _)| stop);
        let summary = run.method_summary("probes", points.len(), done.counters, stop, begun);
        let solves = points.len();
        let spans = direct.spans(run);
        Ok(Self { points, direct, halved, solves, done: FleetRun::default(), summary, spans })
    }

    /// The time steps' error of an output in each row, as if its range were that of the probes.
    pub fn time_error(&self, output: usize, rows: usize) -> Vec<f64> {
        let ranges: Vec<Range> = (0..rows).map(|row| Range::of(&self.direct.at(row, output))).collect();
        let of_row = |row: usize| time_error(ranges[row], &self.direct.at(row, output), &self.halved.at(row, output));
        let time: Vec<f64> = (0..rows).map(of_row).collect();
        BandError::new(&ranges, &vec![0.0; rows], &time, self.spans[output], None).total
    }

    /// The worst of the outputs' time errors, relative to what is allowed: a share of each output's range.
    pub fn worst_share(&self, allowed: f64, rows: usize) -> f64 {
        let share = |output: usize| {
            let span = self.spans[output];
            if span > 0.0 { largest(self.time_error(output, rows)) / (allowed * span) } else { 0.0 }
        };
        largest((0..self.spans.len()).map(share))
    }
}
