//! Each method's samples, run block by block and reduced to bounds.

use std::ops::Range as Rows;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use super::compose::Composition;
use super::study::Study;
use crate::bounds::{ChebyshevBasis, Method, PolynomialRange, Range, ScanBounds, TaylorRange, TensorGrid, Work};
use crate::integrate::{Counters, Fleet, JetRun, Observed, Schedule, SimulationError, Stop};
use crate::model::{ChebyshevRequest, Expand, ScanRequest, TaylorRequest};
use crate::report::MethodSummary;

/// Values (rows × outputs × samples) that one block holds.
const BLOCK: usize = 1 << 20;

/// Samples that a scan runs at once.
const SHARD: usize = 2048;

/// Scalar solves that a jet of order 1 is taken for in the progress bar.
pub(super) const TAYLOR_WORK: usize = 5;

/// One method's band for every output, and what it took.
pub(super) struct Outcome {
    pub(super) bands: Vec<Vec<Range>>,
    pub(super) stop: Option<(Stop, Vec<f64>)>,
    /// What is to be told of bounds that do not go on to the end.
    pub(super) note: Option<String>,
    pub(super) summary: MethodSummary,
    /// The sample whose local error was largest against the tolerance, and how large.
    pub(super) strained: Option<(Vec<f64>, f64)>,
}

/// One pass over all methods with one schedule.
pub(super) struct Run<'a> {
    pub(super) study: &'a Study<'a>,
    pub(super) schedule: &'a Schedule,
    pub(super) tolerance: Option<f64>,
    pub(super) done: AtomicUsize,
    pub(super) total: usize,
}

impl Run<'_> {
    pub(super) fn outputs(&self) -> usize {
        self.study.simulator.program.outputs.len()
    }

    fn bands(&self) -> Vec<Vec<Range>> {
        vec![vec![Range::UNKNOWN; self.schedule.rows]; self.outputs()]
    }

    fn advance_progress(&self, work: usize) {
        let done = self.done.fetch_add(work, Ordering::Relaxed) + work;
        (self.study.progress)((done as f64 / self.total as f64).min(1.0));
    }

    /// Runs samples block by block; `reduce` gets the rows and their values (row, output, sample). Ends at the first block
    /// in which a sample stops.
    fn fleet(
        &self,
        samples: &[Vec<f64>],
        observed: Observed,
        mut reduce: impl FnMut(Rows<usize>, &[f64]),
    ) -> Result<FleetRun, SimulationError> {
        let mut fleet = Fleet::start(&self.study.simulator, samples, self.schedule.first_step())?;
        let rows_a_block = (BLOCK / (observed.count(&self.study.simulator) * samples.len()).max(1)).clamp(1, 64);
        let mut values = Vec::new();
        let mut stop: Option<Stop> = None;
        let mut next = 0;
        while next < self.schedule.rows && stop.is_none() {
            let rows = next..(next + rows_a_block).min(self.schedule.rows);
            let stops = fleet.advance(self.schedule, rows.clone(), self.tolerance, observed, &mut values);
            stop = stops.into_iter().min_by_key(|stop| (stop.row, stop.sample));
            reduce(rows.clone(), &values);
            self.advance_progress(samples.len() * rows.len());
            next = rows.end;
        }
        Ok(FleetRun {
            counters: fleet.counters(),
            strained: fleet.most_strained().map(|(sample, strain)| (samples[sample].clone(), strain)),
            stop: stop.map(|stop| (stop, samples[stop.sample].clone())),
        })
    }

    pub(super) fn method_summary(
        &self,
        method: &str,
        solves: usize,
        counters: Counters,
        stop: Option<&Stop>,
        begun: Instant,
    ) -> MethodSummary {
        let rows = stop.map_or(self.schedule.rows, |stop| stop.row);
        MethodSummary {
            method: method.to_owned(),
            solves,
            steps: self.schedule.steps_before(rows.saturating_sub(1)),
            newton_iterations: counters.iterations,
            rank_revealing_solves: counters.rank_revealing,
            seconds: Some(begun.elapsed().as_secs_f64()),
        }
    }

    pub(super) fn nominal(&self) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let mut bands = self.bands();
        let outputs = self.outputs();
        let done =
            self.fleet(std::slice::from_ref(&self.study.domain.nominal), Observed::Outputs, |rows, values| {
                for (row, values) in rows.zip(values.chunks_exact(outputs)) {
                    for (band, &value) in bands.iter_mut().zip(values) {
                        band[row] = Range { lower: value, upper: value };
                    }
                }
            })?;
        let summary = self.method_summary("nominal", 1, done.counters, done.stop_place(), begun);
        Ok(Outcome { bands, stop: done.stop, note: None, summary, strained: done.strained })
    }

    pub(super) fn chebyshev(&self, request: &ChebyshevRequest) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let basis = ChebyshevBasis::new(&request.order, &request.nodes);
        let samples = self.samples(&basis.grid());
        let mut bands = self.bands();
        let outputs = self.outputs();
        let composition = match request.expand {
            Expand::Coordinates => Composition::new(&self.study.simulator, &self.study.domain, &basis),
            Expand::Output => None,
        };
        let done = match composition {
            Some(mut composition) => {
                let lines = Observed::State.count(&self.study.simulator);
                let mut failure = None;
                let done = self.fleet(&samples, Observed::State, |rows, values| {
                    let times: Vec<f64> = rows.clone().map(|row| self.schedule.time(row)).collect();
                    match composition.ranges(&times, values, lines * samples.len()) {
                        Ok(ranges) => scatter(&mut bands, rows, &ranges, outputs),
                        Err(error) => failure = Some(error),
                    }
                })?;
                failure.map_or(Ok(done), Err)?
            }
            None => {
                let range = PolynomialRange::new(&request.order, request.range);
                self.fleet(&samples, Observed::Outputs, |rows, values| {
                    let ranges: Vec<Range> = values
                        .par_chunks_exact(samples.len())
                        .map_init(
                            || (range.clone(), Work::default()),
                            |(range, work), responses| range.range(basis.coefficients(responses, work)),
                        )
                        .collect();
                    scatter(&mut bands, rows, &ranges, outputs);
                })?
            }
        };
        let summary =
            self.method_summary(Method::Chebyshev.name(), samples.len(), done.counters, done.stop_place(), begun);
        Ok(Outcome { bands, stop: done.stop, note: None, summary, strained: done.strained })
    }

    pub(super) fn scan(&self, request: &ScanRequest) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let grid = TensorGrid::full_factorial(&request.points);
        let outputs = self.outputs();
        let mut bounds = ScanBounds::new(self.schedule.rows, outputs);
        let mut total = FleetRun::default();
        for first in (0..grid.len()).step_by(SHARD) {
            let shard: Vec<Vec<f64>> =
                (first..(first + SHARD).min(grid.len())).map(|index| self.sample(&grid, index)).collect();
            let done = self.fleet(&shard, Observed::Outputs, |rows, values| {
                for (row, values) in rows.zip(values.chunks_exact(outputs * shard.len())) {
                    for (output, values) in values.chunks_exact(shard.len()).enumerate() {
                        bounds.observe_all(row, output, values);
                    }
                }
            })?;
            total.add(first, done);
        }
        let mut bands = self.bands();
        for (output, band) in bands.iter_mut().enumerate() {
            for (row, range) in band.iter_mut().enumerate() {
                *range = bounds.range(row, output);
            }
        }
        let summary = self.method_summary(Method::Scan.name(), grid.len(), total.counters, total.stop_place(), begun);
        Ok(Outcome { bands, stop: total.stop, note: None, summary, strained: total.strained })
    }

    pub(super) fn taylor(&self, request: &TaylorRequest) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let domain = &self.study.domain;
        let k = domain.dimension();
        let space = JetSpace::new(k, request.order);
        let range = TaylorRange::new(k, request.order, request.range);
        let center: Vec<f64> = (0..k).map(|parameter| domain.midpoint(parameter)).collect();
        let slopes: Vec<f64> = (0..k).map(|parameter| domain.half_width(parameter)).collect();
        let mut jet = JetRun::start(&self.study.simulator, &space, &center, &slopes, self.schedule.first_step())?;
        let mut bands = self.bands();
        let outputs = self.outputs();
        let mut values = Vec::new();
        let mut stop = None;
        let mut next = 0;
        while next < self.schedule.rows && stop.is_none() {
            let rows = next..(next + 64).min(self.schedule.rows);
            stop = jet.advance(self.schedule, rows.clone(), &mut values);
            let ranges: Vec<Range> = values
                .par_chunks_exact(space.len())
                .map_init(|| range.clone(), |range, coefficients| range.range(coefficients))
                .collect();
            scatter(&mut bands, rows.clone(), &ranges, outputs);
            self.advance_progress(TAYLOR_WORK * (request.order + 1) * rows.len());
            next = rows.end;
        }
        let summary = self.method_summary(Method::Taylor.name(), 1, jet.counters(), stop.as_ref(), begun);
        Ok(Outcome { bands, stop: stop.map(|stop| (stop, center)), note: None, summary, strained: None })
    }

    fn samples(&self, grid: &TensorGrid) -> Vec<Vec<f64>> {
        (0..grid.len()).map(|index| self.sample(grid, index)).collect()
    }

    fn sample(&self, grid: &TensorGrid, index: usize) -> Vec<f64> {
        let mut parameters = vec![0.0; grid.dimension()];
        self.study.domain.map(&grid.sample(index), &mut parameters);
        parameters
    }
}

#[derive(Default)]
struct FleetRun {
    counters: Counters,
    strained: Option<(Vec<f64>, f64)>,
    stop: Option<(Stop, Vec<f64>)>,
}

impl FleetRun {
    fn stop_place(&self) -> Option<&Stop> {
        self.stop.as_ref().map(|(stop, _)| stop)
    }

    /// Takes in a shard whose first sample is `first`.
    fn add(&mut self, first: usize, shard: Self) {
        self.counters.iterations += shard.counters.iterations;
        self.counters.rank_revealing += shard.counters.rank_revealing;
        let stop = shard.stop.map(|(stop, sample)| (Stop { sample: first + stop.sample, ..stop }, sample));
        self.stop = self.stop.take().into_iter().chain(stop).min_by_key(|(stop, _)| (stop.row, stop.sample));
        let strained = self.strained.take().into_iter().chain(shard.strained);
        self.strained = strained.reduce(|a, b| if b.1 > a.1 { b } else { a });
    }
}

/// Ranges that stand row by row, output by output, into each output's band.
pub(super) fn scatter(bands: &mut [Vec<Range>], rows: Rows<usize>, ranges: &[Range], outputs: usize) {
    for (row, ranges) in rows.zip(ranges.chunks_exact(outputs)) {
        for (band, range) in bands.iter_mut().zip(ranges) {
            band[row] = *range;
        }
    }
}
