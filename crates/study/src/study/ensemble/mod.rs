//! The ensemble of a mechanism's motions under one step schedule, over a box of parameters.

mod answered;
pub(in crate::study) mod closure;
mod combinations;
mod cut;
mod dense;
mod enclosed;
mod jet;
mod nominal;
mod progress;
mod reducing;
mod stored;
mod told;
pub(crate) mod tuning;
mod visits;

use std::ops::Range as Rows;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use self::reducing::keep_reduced;
use super::black_box::source::ProgramSource;
use super::price::instructions_of_step;
use super::reduced::Store;
use crate::certificate::Certified;
use crate::compile::{has_kink, jumps};
use crate::grammar::quantity::Dimension;
use crate::methods::{self, Combination, DenseMotions, EnclosedRow, Ensemble, EnsembleError, FollowedEnds};
use crate::methods::{Proof, Sampling, Simulated, Until};
use crate::numerics::{CutMotions, EMPTY, Ledger, ParameterBox, Range, Sample, ScanBounds, ScanGrid, SegmentMotions};
use crate::simulate::{
    Certifier, Channel, Controller, Integrator, Interruption, Schedule, SimulationError, Simulator, Steps, Stop,
    choose_independent, integrator,
};

pub(super) use jet::jet_about;
pub(super) use nominal::nominal;
pub(super) use progress::Progress;
pub(super) use stored::{Stored, bytes_of_scan, bytes_of_values, samples_of_part, simulate_part};
pub(super) use told::stopped_at;
use told::{effort, observed};
use tuning::TUNING;

/// A mechanism under one schedule.
pub(super) struct Motions<'a> {
    simulator: &'a Simulator,
    domain: &'a ParameterBox,
    schedule: &'a Schedule,
    /// Tolerance of the steps' local errors, if they are controlled.
    tolerance: Option<Controller>,
    progress: &'a Progress<'a>,
    interruption: Interruption<'a>,
    /// Stores the values to which samples are reduced, if outputs are reduced to one number.
    store: Option<&'a Store>,
    channels: &'a [Channel],
    /// Notes all simulated values.
    ledger: Option<&'a Ledger>,
    /// Ends that were followed along gradients, if they were.
    followed: Option<&'a FollowedEnds>,
    /// Simulations that are over: at the end, or where they stopped.
    over: AtomicUsize,
    /// Newton iterations of motions that are cut at events.
    iterations: AtomicU64,
    /// Made when something is enclosed.
    certifier: OnceLock<Certifier<'a>>,
    /// Flags of outputs whose formulas jump, computed on first use: every row asks.
    jumps: OnceLock<Vec<bool>>,
    /// Store of simulations, if they are stored.
    stored: Option<Stored<'a>>,
    /// The program that answers instead of a mechanism, if one does.
    pub(super) source: Option<&'a ProgramSource>,
}

impl<'a> Motions<'a> {
    /// Motions of a mechanism over a box.
    pub fn new(
        simulator: &'a Simulator,
        domain: &'a ParameterBox,
        steps: Steps<'a>,
        progress: &'a Progress<'a>,
        interruption: Interruption<'a>,
    ) -> Self {
        let Steps { schedule, controller: tolerance } = steps;
        let (over, iterations) = (AtomicUsize::new(0), AtomicU64::new(0));
        let (certifier, jumps) = (OnceLock::new(), OnceLock::new());
        let (store, stored, channels, ledger, followed) = (None, None, &[][..], None, None);
        Self {
            simulator,
            domain,
            schedule,
            tolerance,
            progress,
            interruption,
            store,
            channels,
            ledger,
            followed,
            over,
            iterations,
            certifier,
            jumps,
            stored,
            source: None,
        }
    }

    /// The same, which also reduces outputs to one number.
    pub fn keeping(self, store: Option<&'a Store>) -> Self {
        Self { store, channels: store.map_or(&[], |store| &store.plan.channels), ..self }
    }

    /// The same, which reduces outputs to one number by these channels, for others to store.
    pub fn reducing(self, channels: &'a [Channel]) -> Self {
        Self { channels, ..self }
    }

    /// The same, noting all simulated values if there is a ledger for them.
    pub fn noting(self, ledger: Option<&'a Ledger>) -> Self {
        Self { ledger, ..self }
    }

    /// The same, whose simulations are stored.
    pub fn stored(self, stored: Option<Stored<'a>>) -> Self {
        Self { stored, ..self }
    }

    /// The same, with known ends of its outputs.
    pub fn following(self, followed: Option<&'a FollowedEnds>) -> Self {
        Self { followed, ..self }
    }

    /// The same, with samples evaluated by a program.
    pub fn answered_by(self, source: Option<&'a ProgramSource>) -> Self {
        Self { source, ..self }
    }

    /// Steps, and the tolerance of their local errors.
    pub fn steps(&self) -> Steps<'_> {
        Steps { schedule: self.schedule, controller: self.tolerance }
    }

    /// Instructions of a step of one sample.
    pub fn instructions_of_step(&self) -> f64 {
        instructions_of_step(self.simulator)
    }

    /// Rows of a block with `lines` lines of `samples` samples.
    pub fn rows_a_block(lines: usize, samples: usize) -> usize {
        (TUNING.block_values / (lines * samples).max(1)).clamp(1, TUNING.most_rows)
    }

    /// As [`Ensemble::simulate`], whether or not simulations are stored.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn simulate_here(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, SimulationError> {
        if self.simulator.system.analysis.visits() {
            return visits::visit(self, samples, sampling, reduce);
        }
        let mut run = self.start(samples)?;
        Ok(self.advance(run.as_mut(), samples, sampling, reduce))
    }

    /// Samples at their start.
    fn start(&self, samples: &[Sample]) -> Result<Box<dyn Integrator<'a> + 'a>, SimulationError> {
        let mut run = integrator(self.simulator, samples, self.schedule)?;
        run.reduce(self.channels);
        run.heed(self.interruption);
        Ok(run)
    }

    /// Simulations that are over: at the end, or where they stopped.
    pub fn over(&self) -> usize {
        self.over.load(Ordering::Relaxed)
    }

    /// Newton iterations of motions that are cut at events, so far.
    pub fn iterations(&self) -> u64 {
        self.iterations.load(Ordering::Relaxed)
    }

    fn advance(
        &self,
        run: &mut dyn Integrator,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Simulated {
        let observed = observed(sampling.observed);
        let until = sampling.until;
        let rows_a_block = Self::rows_a_block(observed.count(self.simulator), samples.len());
        let mut values = Vec::new();
        let mut stop: Option<Stop> = None;
        let mut stopped = Vec::new();
        let mut next = 0;
        let goes_on = |stop: &Option<Stop>| stop.is_none() || until == Until::End;
        while next < self.schedule.rows && goes_on(&stop) && !self.is_interrupted() {
            let rows = next..(next + rows_a_block).min(self.schedule.rows);
            let stops = run.advance(self.steps(), rows.clone(), observed, &mut values);
            if run.is_cut() {
                break;
            }
            stopped.extend(stops.iter().map(|stop| stop.sample));
            stop = stop.into_iter().chain(stops).min_by_key(|stop| (stop.row, stop.sample));
            reduce(rows.clone(), &values);
            self.progress.advance(samples.len() * rows.len());
            next = rows.end;
        }
        let reduced = if next == self.schedule.rows { run.reduced() } else { Vec::new() };
        keep_reduced(self, samples, &reduced);
        if next == self.schedule.rows || !goes_on(&stop) {
            self.over.fetch_add(samples.len(), Ordering::Relaxed);
        }
        let reached = match &stop {
            Some(stop) if until == Until::FirstStop => stop.row,
            _ => next,
        };
        let stop = stop.map(|stop| Stop { open: run.open_constraint(&stop, self.schedule), ..stop });
        Simulated {
            effort: effort(run.counters()),
            beyond_tolerance_from: run.beyond_tolerance_from(),
            too_deep: run.too_deep().map(|found| told::too_deep(self, found)),
            worst_ratio: run.largest_error_ratio().map(|(sample, ratio)| (samples[sample].clone(), ratio)),
            stop: stop.map(|stop| (stopped_at(&stop), samples[stop.sample].clone())),
            stopped,
            reduced,
            missing: self.schedule.rows - reached,
        }
    }
}

impl Ensemble for Motions<'_> {
    fn domain(&self) -> &ParameterBox {
        self.domain
    }

    fn outputs(&self) -> usize {
        self.simulator.program.outputs.len()
    }

    fn rows(&self) -> usize {
        self.schedule.rows
    }

    fn time(&self, row: usize) -> f64 {
        self.schedule.time(row)
    }

    fn rounding(&self, output: usize) -> f64 {
        let system = &self.simulator.system;
        let duration = self.schedule.output_step * self.schedule.rows as f64;
        // Accelerations are second differences over steps, and forces are their products with all masses.
        let sizes = [system.length, system.mass_of_bodies, duration, self.schedule.first_step()];
        let dimension = system.outputs[output].dimension.filter(|own| *own != Dimension::NUMBER);
        let share = dimension.map_or(TUNING.number_at_rest, |own| TUNING.at_rest * own.size(sizes));
        if share.is_finite() { share } else { 0.0 }
    }

    fn has_kink(&self, output: usize) -> bool {
        let system = &self.simulator.system;
        has_kink(&system.graph, system.outputs[output].expr)
    }

    fn jumps(&self, output: usize) -> bool {
        let of_all = || {
            let system = &self.simulator.system;
            system.outputs.iter().map(|output| jumps(&system.graph, output.expr)).collect()
        };
        self.jumps.get_or_init(of_all)[output]
    }

    fn combinations(&self) -> Vec<Combination<'_>> {
        combinations::of(&self.simulator.system)
    }

    fn seen(&self, row: usize, output: usize) -> Range {
        self.ledger.map_or(EMPTY, |ledger| ledger.range(row, output))
    }

    fn followed(&self) -> Option<&FollowedEnds> {
        self.followed
    }

    fn is_interrupted(&self) -> bool {
        self.interruption.is_asked()
    }

    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError> {
        let lines = methods::lines(self, sampling.observed);
        let mut noted = |rows: Rows<usize>, values: &[f64]| {
            self.ledger.into_iter().for_each(|ledger| ledger.note(rows.start, lines, samples.len(), values));
            reduce(rows, values);
        };
        let simulated = match &self.stored {
            Some(stored) => stored.simulate(self, samples, sampling, &mut noted)?,
            None => self.simulate_here(samples, sampling, &mut noted)?,
        };
        if sampling.whole {
            self.go_on()?;
        }
        Ok(simulated)
    }

    fn dense_motions(&self, samples: &[Sample]) -> Result<Option<DenseMotions>, EnsembleError> {
        Ok(dense::dense(self, samples)?)
    }

    fn segments(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
        Ok(cut::cut(self, samples)?)
    }

    fn segment_jets(&self, space: &JetSpace, xi: &[f64]) -> Result<Option<(usize, SegmentMotions)>, EnsembleError> {
        Ok(cut::cut_jet(self, space, xi)?)
    }

    fn scan(&self, grid: &ScanGrid) -> Result<(ScanBounds, Simulated), EnsembleError> {
        match &self.stored {
            Some(stored) => Ok(stored.scan(self, grid)?),
            None => methods::scan(self, grid, |samples, sampling, reduce| self.simulate(samples, sampling, reduce)),
        }
    }

    fn jets(&self, space: &JetSpace, reduce: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
        Ok(jet::jet_about_middle(self, space, reduce)?)
    }

    fn obstacle_to_enclosure(&self, proof: Proof) -> Option<String> {
        enclosed::obstacle(self.simulator, proof)
    }

    fn enclose(
        &self,
        proof: Proof,
        space: &ModelSpace,
        piece: &ParameterBox,
        row: &mut EnclosedRow,
    ) -> methods::EnclosureEnd {
        match proof {
            Proof::Motion => enclosed::motion(self, space, piece, row),
            Proof::Scheme => enclosed::scheme(self, space, piece, row),
        }
    }

    fn certified(&self) -> Option<Certified> {
        Some(self.certifier.get_or_init(|| Certifier::new(self.simulator)).certified())
    }

    fn scales(&self) -> &[f64] {
        // Nothing is composed from coordinates then.
        if self.simulator.system.analysis.visits() {
            return &[];
        }
        &self.simulator.program.scale
    }

    fn independent(&self, parameters: &[f64], motion: &[f64], time: f64) -> Vec<usize> {
        choose_independent(self.simulator, parameters, motion, time).into_iter().map(|id| id.number()).collect()
    }

    fn closure(&self, independent: Vec<usize>) -> Result<Box<dyn methods::Closure + '_>, EnsembleError> {
        Ok(Box::new(closure::MotionClosure::new(self.simulator, independent)?))
    }
}
