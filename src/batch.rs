//! Runs what a model asks for: every method's samples, on all cores, in bounded memory.
//!
//! Samples run in shards and shards in blocks of output rows, so that memory never grows with samples × steps; each method
//! reduces a block to bounds before the next is run.

use std::ops::Range as Rows;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use crate::bounds::{
    Band, Bounds, ChebyshevBasis, Method, OutputBounds, ParameterBox, PolynomialRange, Range, ScanBounds, TaylorRange,
    TensorGrid, Work,
};
use crate::integrate::{Counters, Fleet, JetRun, Schedule, SimulationError, Simulator, Stop, schedule_for_tolerance};
use crate::mechanics::{self, BuildError, System};
use crate::model::{BoundsRequest, ChebyshevRequest, Description, ScanRequest, Stepping, TaylorRequest};
use crate::report::{MethodSummary, ParameterSummary, Summary};

/// Values (rows × outputs × samples) that one block holds.
const BLOCK: usize = 1 << 20;

/// Samples that a scan runs at once.
const SHARD: usize = 2048;

/// Corners of the box that join the nominal sample as pilots of step-size control.
const PILOT_CORNERS: usize = 15;

/// How often samples that turn out to need smaller steps may be added to the pilots.
const PILOT_ROUNDS: usize = 8;

/// How to run.
pub struct Options<'a> {
    /// Instead of the methods that the model asks for.
    pub methods: Option<Vec<Method>>,
    /// Threads; all cores where absent.
    pub threads: Option<usize>,
    /// Told now and then which fraction is done.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

/// Why nothing could be run at all.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum RunError {
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error("the threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Runs every method asked for. A sample that stops early ends the bounds there: what was reached is returned, and the
/// summary's `failure` says what happened.
///
/// # Errors
/// Where the mechanism cannot be built, assembled or stepped at all.
pub fn run(description: &Description, options: Options) -> Result<(Bounds, Summary), RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or(0)).build()?;
    pool.install(|| {
        let system = mechanics::build(description)?;
        let study = Study::new(description, system, &options)?;
        Ok(study.run()?)
    })
}

/// A compiled model for checking it: what `run` would start from.
///
/// # Errors
/// As for [`run`].
pub fn prepare(description: &Description) -> Result<Simulator, RunError> {
    let system = mechanics::build(description)?;
    Ok(Simulator::new(system, description.simulation.alpha, first_step(description))?)
}

/// Step size for what is computed before the first step.
fn first_step(description: &Description) -> f64 {
    match description.simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => 1e-2 * description.simulation.output_step,
    }
}

struct Study<'a> {
    description: &'a Description,
    simulator: Simulator,
    domain: ParameterBox,
    request: BoundsRequest,
    progress: &'a (dyn Fn(f64) + Sync),
}

/// One method's band for every output, and what it took.
struct Outcome {
    bands: Vec<Vec<Range>>,
    stop: Option<(Stop, Vec<f64>)>,
    summary: MethodSummary,
    /// The sample whose local error was largest against the tolerance, and how large.
    strained: Option<(Vec<f64>, f64)>,
}

impl<'a> Study<'a> {
    fn new(description: &'a Description, system: System, options: &Options<'a>) -> Result<Self, SimulationError> {
        let collect = |pick: fn(&mechanics::UncertainParameter) -> f64| system.parameters.iter().map(pick).collect();
        let domain = ParameterBox {
            nominal: collect(|parameter| parameter.nominal),
            lower: collect(|parameter| parameter.lower),
            upper: collect(|parameter| parameter.upper),
        };
        let request = requested(&description.bounds, options.methods.as_deref(), domain.dimension());
        let simulator = Simulator::new(system, description.simulation.alpha, first_step(description))?;
        Ok(Self { description, simulator, domain, request, progress: options.progress })
    }

    fn run(&self) -> Result<(Bounds, Summary), SimulationError> {
        let simulation = &self.description.simulation;
        let Stepping::Tolerance(tolerance) = simulation.stepping else {
            let Stepping::Fixed(step) = simulation.stepping else { unreachable!("a step is fixed or controlled") };
            let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
            let outcomes = self.methods(&schedule, None)?;
            return Ok(self.conclude(&schedule, outcomes, None));
        };
        // The pilots' schedule is tried on all samples; one that needs smaller steps becomes a pilot, and all run again.
        let mut pilots = self.pilots();
        for round in 1.. {
            let schedule = schedule_for_tolerance(
                &self.simulator,
                &pilots,
                simulation.duration,
                simulation.output_step,
                tolerance,
            )?;
            let outcomes = self.methods(&schedule, Some(tolerance))?;
            let strained = outcomes.iter().filter_map(|outcome| outcome.strained.clone());
            let worst = strained.reduce(|a, b| if b.1 > a.1 { b } else { a });
            match worst {
                Some((sample, strain)) if strain > 1.0 && round < PILOT_ROUNDS => pilots.push(sample),
                Some((_, strain)) if strain > 1.0 => {
                    let note = format!("a sample's local error is {strain:.2} times the tolerance in the worst step");
                    return Ok(self.conclude(&schedule, outcomes, Some(note)));
                }
                _ => return Ok(self.conclude(&schedule, outcomes, None)),
            }
        }
        unreachable!("the rounds end")
    }

    /// The nominal sample and corners of the box.
    fn pilots(&self) -> Vec<Vec<f64>> {
        let k = self.domain.dimension();
        let corners = (1_usize << k.min(PILOT_CORNERS.ilog2() as usize + 1)).min(PILOT_CORNERS);
        let corner = |index: usize| {
            let mut values = vec![0.0; k];
            let xi: Vec<f64> = (0..k).map(|axis| if index >> axis & 1 == 0 { -1.0 } else { 1.0 }).collect();
            self.domain.map(&xi, &mut values);
            values
        };
        let corners = (0..if k == 0 { 0 } else { corners }).map(corner);
        std::iter::once(self.domain.nominal.clone()).chain(corners).collect()
    }

    /// Nominal first, then every method asked for.
    fn methods(&self, schedule: &Schedule, tolerance: Option<f64>) -> Result<Vec<Outcome>, SimulationError> {
        let run = Run { study: self, schedule, tolerance, done: AtomicUsize::new(0), total: self.total_work(schedule) };
        let mut outcomes = vec![run.nominal()?];
        if let Some(request) = &self.request.chebyshev {
            outcomes.push(run.chebyshev(request)?);
        }
        if let Some(request) = &self.request.taylor {
            outcomes.push(run.taylor(request)?);
        }
        if let Some(request) = &self.request.scan {
            outcomes.push(run.scan(request)?);
        }
        Ok(outcomes)
    }

    /// Samples × rows of all methods; a jet counts as its coefficients.
    fn total_work(&self, schedule: &Schedule) -> usize {
        let chebyshev = self.request.chebyshev.as_ref().map_or(0, |request| request.nodes.iter().product());
        let taylor = self.request.taylor.as_ref().map_or(0, |request| TAYLOR_WORK * (request.order + 1));
        let scan = self.request.scan.as_ref().map_or(0, |request| request.points.iter().product());
        (1 + chebyshev + taylor + scan) * schedule.rows
    }

    /// Bounds up to the first row that a sample did not reach, and the summary.
    fn conclude(&self, schedule: &Schedule, outcomes: Vec<Outcome>, note: Option<String>) -> (Bounds, Summary) {
        let stop =
            outcomes.iter().filter_map(|outcome| outcome.stop.as_ref()).min_by_key(|(stop, _)| (stop.row, stop.sample));
        let rows = stop.map_or(schedule.rows, |(stop, _)| stop.row);
        let times: Vec<f64> = (0..rows).map(|row| schedule.time(row)).collect();
        let methods = self.requested_methods();
        let mut outputs: Vec<OutputBounds> = Vec::new();
        for (place, output) in self.simulator.system.outputs.iter().enumerate() {
            let line =
                |outcome: &Outcome, end: fn(&Range) -> f64| outcome.bands[place][..rows].iter().map(end).collect();
            let bands = methods.iter().zip(&outcomes[1..]).map(|(&method, outcome)| Band {
                method,
                lower: line(outcome, |range| range.lower),
                upper: line(outcome, |range| range.upper),
            });
            outputs.push(OutputBounds {
                name: output.name.clone(),
                unit: output.unit.clone(),
                nominal: line(&outcomes[0], |range| range.lower),
                bands: bands.collect(),
            });
        }
        let failure = stop.map(|(stop, sample)| self.failure(stop, sample)).or(note);
        (Bounds { times, outputs }, self.summary(outcomes, failure))
    }

    fn requested_methods(&self) -> Vec<Method> {
        let asked = [self.request.chebyshev.is_some(), self.request.taylor.is_some(), self.request.scan.is_some()];
        Method::ALL.into_iter().zip(asked).filter(|(_, asked)| *asked).map(|(method, _)| method).collect()
    }

    fn failure(&self, stop: &Stop, sample: &[f64]) -> String {
        let names = self.simulator.system.parameters.iter().map(|parameter| parameter.name.clone());
        let stuck = SimulationError::Stuck {
            sample: stop.sample,
            time: stop.time,
            equation: self.simulator.equation_name(stop.equation),
            parameters: names.zip(sample.iter().copied()).collect(),
        };
        format!(
            "{stuck}; results up to that time are kept. Try a smaller step, or see whether the mechanism locks there"
        )
    }

    fn summary(&self, outcomes: Vec<Outcome>, failure: Option<String>) -> Summary {
        let system = &self.simulator.system;
        let mobility = &self.simulator.mobility;
        Summary {
            model: self.description.name.clone(),
            mbint: env!("CARGO_PKG_VERSION").to_owned(),
            coordinates: system.q.len(),
            constraints: system.lambda.len(),
            degrees_of_freedom: mobility.degrees_of_freedom,
            redundant_constraints: mobility.redundant.iter().map(|&k| system.constraints[k].name.clone()).collect(),
            alpha: self.description.simulation.alpha,
            duration: self.description.simulation.duration,
            parameters: system
                .parameters
                .iter()
                .map(|parameter| ParameterSummary {
                    name: parameter.name.clone(),
                    unit: parameter.unit.clone(),
                    nominal: parameter.nominal,
                    lower: parameter.lower,
                    upper: parameter.upper,
                })
                .collect(),
            methods: outcomes.into_iter().map(|outcome| outcome.summary).collect(),
            failure,
        }
    }
}

/// Scalar solves that a jet of order 1 is taken for in the progress bar.
const TAYLOR_WORK: usize = 5;

/// What is run: the model's requests, or defaults for methods named on the command line.
fn requested(model: &BoundsRequest, methods: Option<&[Method]>, k: usize) -> BoundsRequest {
    let Some(methods) = methods else { return model.clone() };
    let asked = |method: Method| methods.contains(&method);
    let chebyshev = || model.chebyshev.clone().unwrap_or_else(|| ChebyshevRequest::of_order(5, k));
    let taylor = || model.taylor.clone().unwrap_or_else(TaylorRequest::default);
    let scan = || model.scan.clone().unwrap_or_else(|| ScanRequest::of_points(30, k));
    BoundsRequest {
        chebyshev: asked(Method::Chebyshev).then(chebyshev),
        taylor: asked(Method::Taylor).then(taylor),
        scan: asked(Method::Scan).then(scan),
    }
}

/// One pass over all methods with one schedule.
struct Run<'a> {
    study: &'a Study<'a>,
    schedule: &'a Schedule,
    tolerance: Option<f64>,
    done: AtomicUsize,
    total: usize,
}

impl Run<'_> {
    fn outputs(&self) -> usize {
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
        mut reduce: impl FnMut(Rows<usize>, &[f64]),
    ) -> Result<FleetRun, SimulationError> {
        let mut fleet = Fleet::start(&self.study.simulator, samples, self.schedule.first_step())?;
        let rows_a_block = (BLOCK / (self.outputs() * samples.len()).max(1)).clamp(1, 64);
        let mut values = Vec::new();
        let mut stop: Option<Stop> = None;
        let mut next = 0;
        while next < self.schedule.rows && stop.is_none() {
            let rows = next..(next + rows_a_block).min(self.schedule.rows);
            let stops = fleet.advance(self.schedule, rows.clone(), self.tolerance, &mut values);
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

    fn method_summary(&self, method: &str, solves: usize, counters: Counters, begun: Instant) -> MethodSummary {
        MethodSummary {
            method: method.to_owned(),
            solves,
            steps: self.schedule.steps_before(self.schedule.rows - 1),
            newton_iterations: counters.iterations,
            rank_revealing_solves: counters.rank_revealing,
            seconds: Some(begun.elapsed().as_secs_f64()),
        }
    }

    fn nominal(&self) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let mut bands = self.bands();
        let outputs = self.outputs();
        let done = self.fleet(std::slice::from_ref(&self.study.domain.nominal), |rows, values| {
            for (row, values) in rows.zip(values.chunks_exact(outputs)) {
                for (band, &value) in bands.iter_mut().zip(values) {
                    band[row] = Range { lower: value, upper: value };
                }
            }
        })?;
        let summary = self.method_summary("nominal", 1, done.counters, begun);
        Ok(Outcome { bands, stop: done.stop, summary, strained: done.strained })
    }

    fn chebyshev(&self, request: &ChebyshevRequest) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let basis = ChebyshevBasis::new(&request.order, &request.nodes);
        let samples = self.samples(&basis.grid());
        let range = PolynomialRange::new(&request.order, request.range);
        let mut bands = self.bands();
        let outputs = self.outputs();
        let done = self.fleet(&samples, |rows, values| {
            let ranges: Vec<Range> = values
                .par_chunks_exact(samples.len())
                .map_init(
                    || (range.clone(), Work::default()),
                    |(range, work), responses| range.range(basis.coefficients(responses, work)),
                )
                .collect();
            scatter(&mut bands, rows, &ranges, outputs);
        })?;
        let summary = self.method_summary(Method::Chebyshev.name(), samples.len(), done.counters, begun);
        Ok(Outcome { bands, stop: done.stop, summary, strained: done.strained })
    }

    fn scan(&self, request: &ScanRequest) -> Result<Outcome, SimulationError> {
        let begun = Instant::now();
        let grid = TensorGrid::full_factorial(&request.points);
        let outputs = self.outputs();
        let mut bounds = ScanBounds::new(self.schedule.rows, outputs);
        let (mut counters, mut stop, mut strained): (Counters, Option<(Stop, Vec<f64>)>, Option<(Vec<f64>, f64)>) =
            Default::default();
        for first in (0..grid.len()).step_by(SHARD) {
            let shard: Vec<Vec<f64>> =
                (first..(first + SHARD).min(grid.len())).map(|index| self.sample(&grid, index)).collect();
            let done = self.fleet(&shard, |rows, values| {
                for (row, values) in rows.zip(values.chunks_exact(outputs * shard.len())) {
                    for (output, values) in values.chunks_exact(shard.len()).enumerate() {
                        bounds.observe_all(row, output, values);
                    }
                }
            })?;
            counters.iterations += done.counters.iterations;
            counters.rank_revealing += done.counters.rank_revealing;
            let found = done.stop.map(|(stop, sample)| (Stop { sample: first + stop.sample, ..stop }, sample));
            stop = stop.into_iter().chain(found).min_by_key(|(stop, _)| (stop.row, stop.sample));
            strained = strained.into_iter().chain(done.strained).reduce(|a, b| if b.1 > a.1 { b } else { a });
        }
        let mut bands = self.bands();
        for (output, band) in bands.iter_mut().enumerate() {
            for (row, range) in band.iter_mut().enumerate() {
                *range = bounds.range(row, output);
            }
        }
        let summary = self.method_summary(Method::Scan.name(), grid.len(), counters, begun);
        Ok(Outcome { bands, stop, summary, strained })
    }

    fn taylor(&self, request: &TaylorRequest) -> Result<Outcome, SimulationError> {
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
        let summary = self.method_summary(Method::Taylor.name(), 1, jet.counters(), begun);
        Ok(Outcome { bands, stop: stop.map(|stop| (stop, center)), summary, strained: None })
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

struct FleetRun {
    counters: Counters,
    strained: Option<(Vec<f64>, f64)>,
    stop: Option<(Stop, Vec<f64>)>,
}

/// Ranges that stand row by row, output by output, into each output's band.
fn scatter(bands: &mut [Vec<Range>], rows: Rows<usize>, ranges: &[Range], outputs: usize) {
    for (row, ranges) in rows.zip(ranges.chunks_exact(outputs)) {
        for (band, range) in bands.iter_mut().zip(ranges) {
            band[row] = *range;
        }
    }
}
