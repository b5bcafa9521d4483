//! Each method's samples, run block by block and reduced to bounds.

use std::ops::Range as Rows;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use super::adapt::{Adaptation, Goal};
use super::apportion::{Apportion, Parts};
use super::compose::{Composer, Known, Row, Seeker};
use super::finding::{Finder, Finding};
use super::probe::Probes;
use super::run::Study;
use crate::model::{BoundsRequest, ChebyshevRequest, Degree, Expand, ScanRequest, TaylorRequest};
use crate::numerics::{
    PolynomialRange, Range, ScanBounds, SparseWork, Surrogate, SurrogateWork, TaylorRange, TensorGrid, largest,
    surrogate_error,
};
use crate::results::Method;
use crate::results::MethodSummary;
use crate::simulate::{Counters, EnsembleRun, JetRun, Observed, Schedule, SimulationError, SingularPass, Stop};

/// Values (rows × outputs × samples) that one block holds.
const BLOCK: usize = 1 << 20;

/// Fewest and most samples that a scan runs at once.
const SHARD: usize = 2048;
const LARGEST_SHARD: usize = 16384;

/// The least share of a tolerance that is left to the surrogate, whatever the steps take.
const LEAST_SHARE: f64 = 0.25;

/// Scalar solves that a jet of order 1 is taken for in the progress bar.
pub(super) const TAYLOR_WORK: usize = 5;

/// One method's band for every output, its surrogate's error, and what it took.
pub(super) struct Outcome {
    pub(super) bands: Vec<Vec<Range>>,
    pub(super) surrogate: Vec<Vec<f64>>,
    /// The time steps' error, where the method knows it better than the probes' outputs do; else not a number.
    pub(super) steps: Vec<Vec<f64>>,
    /// Who has which part in the spread of every output in every row, where it is known.
    pub(super) parts: Vec<Vec<Option<Parts>>>,
    pub(super) stop: Option<(Stop, Vec<f64>)>,
    /// Rows in which something is known.
    pub(super) reached: usize,
    /// What is to be told of bounds that do not go on to the end.
    pub(super) note: Option<String>,
    pub(super) summary: MethodSummary,
    /// The sample whose local errors add up to most, and to how much over the tolerance.
    pub(super) strained: Option<(Vec<f64>, f64)>,
    /// Singular configurations that the nominal sample passes.
    pub(super) singular: Vec<SingularPass>,
}

/// One pass over all methods with one schedule.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) study: &'a Study<'a>,
    pub(super) schedule: &'a Schedule,
    pub(super) tolerance: Option<f64>,
    pub(super) progress: &'a Progress,
    /// Whether samples are run to their end even where the user does not want to wait: half of them would be of no use.
    pub(super) finish: bool,
}

/// How long samples are run together of which one stops before the schedule ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Until {
    /// To that one's end: without it the others say nothing.
    First,
    /// To the schedule's: the others are of use without it.
    End,
}

/// How far a run has come.
pub(super) struct Progress {
    pub(super) done: AtomicUsize,
    pub(super) total: usize,
}

impl Run<'_> {
    pub(super) fn outputs(&self) -> usize {
        self.study.simulator.program.outputs.len()
    }

    fn advance_progress(&self, work: usize) {
        let Progress { done, total } = self.progress;
        let done = done.fetch_add(work, Ordering::Relaxed) + work;
        (self.study.progress)((done as f64 / *total as f64).min(1.0));
    }

    /// Runs samples block by block; `reduce` gets the rows and their values (row, output, sample). Ends at a block in which
    /// samples stop, as `until` says, or where the user does not want to wait any more.
    pub(super) fn fleet(
        &self,
        samples: &[Vec<f64>],
        observed: Observed,
        until: Until,
        reduce: impl FnMut(Rows<usize>, &[f64]),
    ) -> Result<FleetRun, SimulationError> {
        let fleet = EnsembleRun::start(&self.study.simulator, samples, self.schedule.first_step())?;
        Ok(self.steer(fleet, samples, observed, until, reduce))
    }

    fn steer(
        &self,
        mut fleet: EnsembleRun,
        samples: &[Vec<f64>],
        observed: Observed,
        until: Until,
        mut reduce: impl FnMut(Rows<usize>, &[f64]),
    ) -> FleetRun {
        let rows_a_block = (BLOCK / (observed.count(&self.study.simulator) * samples.len()).max(1)).clamp(1, 64);
        let mut values = Vec::new();
        let mut stop: Option<Stop> = None;
        let mut stopped = Vec::new();
        let mut next = 0;
        let goes_on = |stop: &Option<Stop>| stop.is_none() || until == Until::End;
        while next < self.schedule.rows && goes_on(&stop) && !self.is_interrupted() {
            let rows = next..(next + rows_a_block).min(self.schedule.rows);
            let stops = fleet.advance(self.schedule, rows.clone(), self.tolerance, observed, &mut values);
            stopped.extend(stops.iter().map(|stop| stop.sample));
            stop = stop.into_iter().chain(stops).min_by_key(|stop| (stop.row, stop.sample));
            reduce(rows.clone(), &values);
            self.advance_progress(samples.len() * rows.len());
            next = rows.end;
        }
        let reached = match &stop {
            Some(stop) if until == Until::First => stop.row,
            _ => next,
        };
        let stop = stop.map(|stop| Stop { open: fleet.open_constraint(&stop, self.schedule), ..stop });
        FleetRun {
            counters: fleet.counters(),
            strained: fleet.largest_error_ratio().map(|(sample, strain)| (samples[sample].clone(), strain)),
            stop: stop.map(|stop| (stop, samples[stop.sample].clone())),
            singular: fleet.singular_passes(),
            stopped,
            missing: self.schedule.rows - reached,
        }
    }

    /// Whether the user does not want to wait any more.
    pub(super) fn is_interrupted(&self) -> bool {
        !self.finish && (self.study.interrupted)()
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
            order: None,
            boxes: None,
            seconds: Some(begun.elapsed().as_secs_f64()),
        }
    }

    pub(super) fn nominal(&self) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let mut lines = Lines::new(self);
        let outputs = self.outputs();
        let sample = std::slice::from_ref(&self.study.domain.nominal);
        let fleet = EnsembleRun::start(&self.study.simulator, sample, self.schedule.first_step())?.watching();
        let done = self.steer(fleet, sample, Observed::Outputs, Until::First, |rows, values| {
            for (row, values) in rows.zip(values.chunks_exact(outputs)) {
                for (output, &value) in values.iter().enumerate() {
                    lines.set(row, output, Range { lower: value, upper: value }, 0.0);
                }
            }
        });
        let summary = self.method_summary("nominal", 1, done.counters, done.stop_place(), begun);
        Ok(lines.outcome(done, summary))
    }

    pub(super) fn chebyshev(&self, request: &ChebyshevRequest, probes: &Probes) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let Degree::Fixed { order, nodes } = &request.degree else { return self.adapted(probes) };
        let surrogate = Surrogate::tensor(order, nodes);
        let samples = self.study.domain.points(surrogate.samples());
        let (lines, done) = match request.expand {
            Expand::Coordinates if self.study.composes() => self.composed(&surrogate, &samples, probes)?,
            _ => {
                let range = PolynomialRange::new(order, request.range);
                self.expanded(&surrogate, range, &samples, probes)?
            }
        };
        let summary =
            self.method_summary(Method::Chebyshev.name(), samples.len(), done.counters, done.stop_place(), begun);
        Ok(lines.outcome(done, summary))
    }

    /// To the degree that the tolerance asks for.
    fn adapted(&self, probes: &Probes) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let tolerance = self.study.request.tolerance.unwrap_or(BoundsRequest::TOLERANCE);
        let mut goal = Goal {
            allowed: Vec::new(),
            rows: self.schedule.rows,
            budget: self.study.request.budget,
            spent: probes.solves,
        };
        for output in 0..self.outputs() {
            let (span, time) = (probes.spans[output], probes.time_error(output, self.schedule.rows));
            let allowed = tolerance * span;
            // Where the steps miss the tolerance nothing is to be gained.
            let missed = |time: &f64| time.is_nan() || *time > allowed;
            let resolved = time.iter().position(missed).unwrap_or(self.schedule.rows);
            goal.rows = goal.rows.min(if span > 0.0 { resolved } else { goal.rows });
            let time = largest(time[..resolved].iter().copied());
            goal.allowed.push(if span > 0.0 { (allowed - time).max(LEAST_SHARE * allowed) } else { f64::INFINITY });
        }
        let search = Adaptation::new(&Run { finish: true, ..*self }, goal, probes).search()?;
        let mut lines = Lines::new(self);
        for (place, found) in search.found.into_iter().enumerate() {
            lines.set_found(place / self.outputs(), place % self.outputs(), found);
        }
        let solves = search.solves - probes.solves;
        let stop = search.done.stop_place();
        let mut summary = self.method_summary(Method::Chebyshev.name(), solves, search.done.counters, stop, begun);
        summary.order = Some(search.order);
        summary.boxes = Some(search.boxes);
        Ok(lines.outcome(search.done, summary))
    }

    /// The outputs follow from the expanded independent coordinates.
    fn composed(
        &self,
        surrogate: &Surrogate,
        samples: &[Vec<f64>],
        probes: &Probes,
    ) -> Result<(Lines, FleetRun), SimulationError> {
        let mut lines = Lines::new(self);
        let mut composer = Composer::new(&self.study.simulator);
        let seeker = Seeker::new(self.study.domain.dimension());
        let finder = Finder {
            seeker: &seeker,
            held_out: (&probes.points, &probes.direct),
            halved: Some((&probes.direct, &probes.halved)),
            apportion: Some(Apportion::new(&self.study.domain, surrogate)),
        };
        let stride = Observed::Motion.count(&self.study.simulator) * samples.len();
        let mut failure = None;
        let done = self.fleet(samples, Observed::Motion, Until::First, |rows, values| {
            let times: Vec<f64> = rows.clone().map(|row| self.schedule.time(row)).collect();
            let first = rows.start;
            let look = |place: usize, row: &Row, known: &mut Known| finder.find(row, first + place, known);
            match composer.rows(surrogate, &self.study.domain, &times, (values, stride), look) {
                Ok(found) => {
                    for (row, found) in rows.zip(found) {
                        found.into_iter().enumerate().for_each(|(output, found)| lines.set_found(row, output, found));
                    }
                }
                Err(error) => failure = Some(error),
            }
        })?;
        failure.map_or(Ok((lines, done)), Err)
    }

    /// The outputs themselves are expanded.
    fn expanded(
        &self,
        surrogate: &Surrogate,
        range: PolynomialRange,
        samples: &[Vec<f64>],
        probes: &Probes,
    ) -> Result<(Lines, FleetRun), SimulationError> {
        let mut lines = Lines::new(self);
        let done = self.fleet(samples, Observed::Outputs, Until::First, |rows, values| {
            let found: Vec<Found> = values
                .par_chunks_exact(samples.len())
                .map_init(
                    || (range.clone(), SurrogateWork::default(), SparseWork::default()),
                    |(range, work, sparse), responses| {
                        let coefficients = surrogate.coefficients(responses, work);
                        let mut at_probes = vec![0.0; probes.points.len()];
                        surrogate.basis().values(&probes.points, &coefficients, &mut at_probes, sparse);
                        let enclosed = range.enclose(&coefficients);
                        Found { range: enclosed.outer, excess: enclosed.excess(), at_probes }
                    },
                )
                .collect();
            lines.set_all(rows, &found, probes);
        })?;
        Ok((lines, done))
    }

    pub(super) fn scan(&self, request: &ScanRequest, probes: &Probes) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let grid = TensorGrid::full_factorial(&request.points);
        let outputs = self.outputs();
        let mut bounds = ScanBounds::new(self.schedule.rows, outputs, &request.points);
        let mut total = FleetRun::default();
        // Slabs of the first axis stay together, so that neighbours do.
        let slab = grid.len() / request.points.first().copied().unwrap_or(1);
        let shard_size = slab.saturating_mul(3).clamp(SHARD, LARGEST_SHARD);
        for first in (0..grid.len()).step_by(shard_size) {
            if self.is_interrupted() {
                // What some of the samples say is no bound.
                total.missing = self.schedule.rows;
                break;
            }
            let shard: Vec<Vec<f64>> =
                (first..(first + shard_size).min(grid.len())).map(|index| self.sample(&grid, index)).collect();
            let done = self.fleet(&shard, Observed::Outputs, Until::End, |rows, values| {
                for (row, values) in rows.zip(values.chunks_exact(outputs * shard.len())) {
                    for (output, values) in values.chunks_exact(shard.len()).enumerate() {
                        bounds.observe(row, output, first, values);
                    }
                }
            })?;
            total.add(first, done);
        }
        let mut lines = Lines::new(self);
        for (row, output) in (0..self.schedule.rows).flat_map(|row| (0..outputs).map(move |output| (row, output))) {
            let range = bounds.range(row, output);
            let outside = probes.direct.at(row, output).into_iter().map(|value| range.distance(value));
            lines.set(row, output, range, largest(outside.chain([bounds.error(row, output)])));
        }
        let summary = self.method_summary(Method::Scan.name(), grid.len(), total.counters, total.stop_place(), begun);
        Ok(lines.outcome(total, summary))
    }

    pub(super) fn taylor(&self, request: &TaylorRequest, probes: &Probes) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let domain = &self.study.domain;
        let k = domain.dimension();
        let space = JetSpace::new(k, request.order);
        let range = TaylorRange::new(k, request.order, request.range);
        let center: Vec<f64> = (0..k).map(|parameter| domain.midpoint(parameter)).collect();
        let slopes: Vec<f64> = (0..k).map(|parameter| domain.half_width(parameter)).collect();
        let mut jet = JetRun::start(&self.study.simulator, &space, &center, &slopes, self.schedule.first_step())?;
        let mut lines = Lines::new(self);
        let mut values = Vec::new();
        let mut stop = None;
        let mut next = 0;
        while next < self.schedule.rows && stop.is_none() && !self.is_interrupted() {
            let rows = next..(next + 64).min(self.schedule.rows);
            stop = jet.advance(self.schedule, rows.clone(), &mut values);
            let found: Vec<Found> = values
                .par_chunks_exact(space.len())
                .map_init(
                    || range.clone(),
                    |range, coefficients| {
                        let at_probe = |xi: &Vec<f64>| range.monomials().evaluate(coefficients, xi);
                        let at_probes = probes.points.iter().map(at_probe).collect();
                        let (range, excess) = range.enclose(coefficients);
                        Found { range, excess, at_probes }
                    },
                )
                .collect();
            lines.set_all(rows.clone(), &found, probes);
            self.advance_progress(TAYLOR_WORK * (request.order + 1) * rows.len());
            next = rows.end;
        }
        let summary = self.method_summary(Method::Taylor.name(), 1, jet.counters(), stop.as_ref(), begun);
        let missing = self.schedule.rows - stop.map_or(next, |stop| stop.row);
        let done = FleetRun {
            counters: jet.counters(),
            stop: stop.map(|stop| (stop, center)),
            missing,
            ..FleetRun::default()
        };
        Ok(lines.outcome(done, summary))
    }

    fn sample(&self, grid: &TensorGrid, index: usize) -> Vec<f64> {
        self.study.domain.point(&grid.sample(index))
    }
}

/// What samples run together took, and the first that stopped.
#[derive(Default)]
pub(super) struct FleetRun {
    pub(super) counters: Counters,
    pub(super) strained: Option<(Vec<f64>, f64)>,
    pub(super) stop: Option<(Stop, Vec<f64>)>,
    pub(super) singular: Vec<SingularPass>,
    /// All that stopped.
    pub(super) stopped: Vec<usize>,
    /// Rows at the end in which too little is known.
    pub(super) missing: usize,
}

impl FleetRun {
    pub(super) fn stop_place(&self) -> Option<&Stop> {
        self.stop.as_ref().map(|(stop, _)| stop)
    }

    /// Takes in a shard whose first sample is `first`.
    pub(super) fn add(&mut self, first: usize, shard: Self) {
        self.counters.iterations += shard.counters.iterations;
        self.counters.rank_revealing += shard.counters.rank_revealing;
        let stop = shard.stop.map(|(stop, sample)| (Stop { sample: first + stop.sample, ..stop }, sample));
        self.stop = self.stop.take().into_iter().chain(stop).min_by_key(|(stop, _)| (stop.row, stop.sample));
        self.stopped.extend(shard.stopped.into_iter().map(|sample| first + sample));
        self.missing = self.missing.max(shard.missing);
        let strained = self.strained.take().into_iter().chain(shard.strained);
        self.strained = strained.reduce(|a, b| if b.1 > a.1 { b } else { a });
    }
}

/// An output's polynomial in a row: its range, how much too wide that may be, and its values at the probes.
struct Found {
    range: Range,
    excess: f64,
    at_probes: Vec<f64>,
}

/// What a method finds of every output in every row.
pub(super) struct Lines {
    bands: Vec<Vec<Range>>,
    surrogate: Vec<Vec<f64>>,
    steps: Vec<Vec<f64>>,
    parts: Vec<Vec<Option<Parts>>>,
}

impl Lines {
    /// Of which nothing is known yet.
    pub(super) fn new(run: &Run) -> Self {
        let (outputs, rows) = (run.outputs(), run.schedule.rows);
        Self {
            bands: vec![vec![Range::UNKNOWN; rows]; outputs],
            surrogate: vec![vec![f64::NAN; rows]; outputs],
            steps: vec![vec![f64::NAN; rows]; outputs],
            parts: vec![vec![None; rows]; outputs],
        }
    }

    fn set_found(&mut self, row: usize, output: usize, found: Finding) {
        self.set(row, output, found.range, found.error);
        self.steps[output][row] = found.step_error;
        self.parts[output][row] = found.parts;
    }

    pub(super) fn set(&mut self, row: usize, output: usize, range: Range, surrogate: f64) {
        self.bands[output][row] = range;
        self.surrogate[output][row] = surrogate;
    }

    /// Row by row, output by output.
    fn set_all(&mut self, rows: Rows<usize>, found: &[Found], probes: &Probes) {
        for (row, found) in rows.zip(found.chunks_exact(self.bands.len())) {
            for (output, Found { range, excess, at_probes }) in found.iter().enumerate() {
                let error = surrogate_error(at_probes, &probes.direct.at(row, output));
                self.set(row, output, *range, error + excess);
            }
        }
    }

    /// All rows but those that are missing.
    pub(super) fn outcome(mut self, done: FleetRun, summary: MethodSummary) -> Outcome {
        let rows = self.bands.first().map_or(0, Vec::len);
        let reached = rows - done.missing.min(rows);
        self.bands.iter_mut().for_each(|ranges| ranges[reached..].fill(Range::UNKNOWN));
        self.surrogate.iter_mut().chain(&mut self.steps).for_each(|errors| errors[reached..].fill(f64::NAN));
        self.parts.iter_mut().for_each(|parts| parts[reached..].fill(None));
        Outcome {
            bands: self.bands,
            surrogate: self.surrogate,
            steps: self.steps,
            parts: self.parts,
            stop: done.stop,
            reached,
            note: None,
            summary,
            strained: done.strained,
            singular: done.singular,
        }
    }
}
