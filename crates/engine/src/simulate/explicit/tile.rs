//! Samples, or a jet, over a schedule whose steps pass over its rows.

use std::fmt::Debug;

use rayon::prelude::*;
use symdiff::WIDTHS;
use symdiff::jet::JetSpace;

use super::runge_kutta::{RungeKutta, end_of_stages};
use super::tuning::TUNING;
use crate::assemble::EquationId;
use crate::numerics::Sample;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::PartingWatch;
use crate::simulate::drive::{
    Accumulator, Channel, MotionSteps as _, Observed, RowState, RowTile, Stop, TiledRun, forget_lost, lost_lanes,
};
use crate::simulate::ensemble::{JetBox, JetClosure, RowClosure};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// The run of an ensemble of samples by the explicit method.
pub(in crate::simulate) type ExplicitRun<'s> = TiledRun<'s, ExplicitTile<'s, RowClosure<'s>>>;

/// The run of one jet by the explicit method.
pub(in crate::simulate) type ExplicitJets<'s> = TiledRun<'s, ExplicitTile<'s, JetClosure<'s>>>;

/// Lanes, or a jet, between two steps.
#[derive(Debug)]
pub(in crate::simulate) struct ExplicitTile<'s, M> {
    pub(super) motion: M,
    /// Closure of rows, whose accelerations are those of their own states; rows of a jet use that of the motion.
    rows: Option<M>,
    pub(super) run: RungeKutta,
    /// The state at the start.
    pub(super) start: Vec<f64>,
    /// First sample, and how many lanes are samples.
    pub(super) first: usize,
    pub(super) count: usize,
    /// Steps that are begun.
    steps: usize,
    /// Lanes that still run.
    pub(super) alive: Vec<bool>,
    /// The state at the row.
    at_row: Vec<f64>,
    /// Registers of the first lane at the start.
    registers: Vec<f64>,
    /// Accumulator of outputs that are reduced to one number.
    reduction: Option<Accumulator<'s>>,
    /// Search for constraints that the first lane leaves open.
    parting: Option<PartingWatch<'s>>,
}

/// Samples in tiles for `threads` threads, assembled.
///
/// # Errors
/// The first sample that cannot be assembled.
pub(super) fn tiles<'s>(
    simulator: &'s Simulator,
    samples: &[Sample],
    threads: usize,
) -> Result<Vec<ExplicitTile<'s, RowClosure<'s>>>, SimulationError> {
    let at_once = samples.len().div_ceil(threads.max(1)).clamp(1, TUNING.run_width);
    let at_once = WIDTHS.into_iter().find(|&width| width >= at_once).unwrap_or(TUNING.run_width);
    let of_tile = |(index, samples): (usize, &[Sample])| {
        let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
        let start = simulator.assemble(width, 0.0, |lane| samples[lane.min(samples.len() - 1)].clone())?;
        let motion = RowClosure::new(simulator, &start)?;
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let rows = Some(RowClosure::new(simulator, &start)?);
        let registers = (0..layout.registers()).map(|register| start.lane(register)[0]).collect();
        let tile = ExplicitTile::new(motion, rows, state, registers);
        Ok(ExplicitTile { first: index * at_once, count: samples.len(), ..tile })
    };
    let chunks: Vec<(usize, &[Sample])> = samples.chunks(at_once).enumerate().collect();
    chunks.into_par_iter().map(of_tile).collect()
}

impl<'s> ExplicitRun<'s> {
    /// Assembles samples.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(simulator: &'s Simulator, samples: &[Sample]) -> Result<Self, SimulationError> {
        Ok(Self::of(simulator, tiles(simulator, samples, rayon::current_num_threads())?))
    }
}

impl<'s> ExplicitJets<'s> {
    /// Assembles the jet around `center`; the parameters' half widths are its first derivatives.
    ///
    /// # Errors
    /// Where the centre cannot be assembled.
    pub fn start(simulator: &'s Simulator, space: &'s JetSpace, about: JetBox<'_>) -> Result<Self, SimulationError> {
        let start = simulator.assemble(1, 0.0, |_| about.center.iter().copied().collect())?;
        let mut motion = JetClosure::new(simulator, space, about, &start)?;
        let state = motion.start(simulator, space, about)?;
        let registers = start.values()[..simulator.start.layout.registers()].to_vec();
        Ok(Self::of(simulator, vec![ExplicitTile::new(motion, None, state, registers)]))
    }
}

impl<'s, M: RowState> ExplicitTile<'s, M> {
    /// A tile in a state at the start, whose first lane has these registers.
    fn new(mut motion: M, rows: Option<M>, state: Vec<f64>, registers: Vec<f64>) -> Self {
        let run = RungeKutta::start(&mut motion, 0.0, state.clone());
        let width = motion.width();
        Self {
            motion,
            rows,
            run,
            at_row: state.clone(),
            start: state,
            first: 0,
            count: width,
            steps: 0,
            alive: vec![true; width],
            registers,
            reduction: None,
            parting: None,
        }
    }

    /// Takes the steps that lead to a time, and interpolates the state there; a step that passes it stays open.
    fn step_to(&mut self, plan: &StepEnds<'_>, time: f64, asked: &mut StepInterruption<'_>) {
        // `steps` counts the steps that are begun; the last of them is open until a row lies beyond its end.
        while time > self.run.time {
            let open = self.steps.checked_sub(1).filter(|&last| plan.ends[last] > self.run.time);
            let step = match open {
                Some(step) => step,
                None => {
                    if plan.ends.len() == self.steps {
                        break;
                    }
                    if asked.ends() {
                        return;
                    }
                    self.steps += 1;
                    self.attempt(plan, self.steps - 1, time);
                    self.steps - 1
                }
            };
            let end = plan.ends[step];
            if time < end {
                self.run.interpolate(plan.share_of_dense(step, self.run.time, time), &mut self.at_row);
                return;
            }
            self.run.accept(&mut self.motion, end);
        }
        self.at_row.copy_from_slice(&self.run.state);
    }

    /// Tries a step, with dense output if a time lies within it.
    fn attempt(&mut self, plan: &StepEnds<'_>, step: usize, time: f64) {
        let end = plan.ends[step];
        if plan.is_at_event(step) {
            self.run.attempt_to_event(&mut self.motion, end);
            self.accumulate_step(plan, step);
            return;
        }
        self.run.attempt(&mut self.motion, end);
        self.run.finish(&mut self.motion, end);
        if self.reduction.is_some() || time < end {
            self.run.prepare_dense(&mut self.motion, end);
        }
        self.accumulate_step(plan, step);
    }

    /// Accumulates the reductions of outputs over the step that was tried, if any.
    fn accumulate_step(&mut self, plan: &StepEnds<'_>, step: usize) {
        if self.reduction.is_none() {
            return;
        }
        let (begin, end) = (self.run.time, plan.ends[step]);
        for part in 1..=TUNING.places_of_reduced {
            let time = begin + part as f64 / TUNING.places_of_reduced as f64 * (end - begin);
            self.run.interpolate(plan.share_of_dense(step, begin, time), &mut self.at_row);
            self.accumulate(time);
        }
    }

    /// Accumulates the reductions of the row's outputs, if any.
    fn accumulate(&mut self, time: f64) {
        if let Some(reduction) = &mut self.reduction {
            let mut values = reduction.buffer();
            let rows = self.rows.as_mut().unwrap_or(&mut self.motion);
            rows.close(time, &mut self.at_row);
            rows.observe(&mut values);
            reduction.push(time, values, &self.alive);
        }
    }

    /// The stop of a jet at a row whose state is not finite.
    fn lost_jet(&mut self, row: usize, time: f64) -> Option<Stop> {
        let index = self.at_row.iter().position(|value| !value.is_finite())?;
        self.alive.fill(false);
        let (width, lines) = (self.alive.len(), self.at_row.len() / self.alive.len());
        let equation = EquationId::new(index / width % (lines / 2).max(1));
        Some(Stop { sample: 0, row, time, equation, open: None, singular: true })
    }
}

/// A schedule, and the times at which its steps end.
#[derive(Debug)]
pub(in crate::simulate) struct StepEnds<'p> {
    schedule: &'p Schedule,
    ends: Vec<f64>,
    at_events: Vec<usize>,
}

impl StepEnds<'_> {
    /// Whether a step ends at an event.
    fn is_at_event(&self, step: usize) -> bool {
        self.at_events.binary_search(&step).is_ok()
    }

    /// Share of a step's dense output, from its beginning, that a time within it is; both times in s.
    fn share_of_dense(&self, step: usize, begin: f64, time: f64) -> f64 {
        let end = end_of_stages(begin, self.ends[step], self.is_at_event(step));
        (time - begin) / (end - begin)
    }
}

impl<'s, M: RowState + Debug + Send> RowTile<'s> for ExplicitTile<'s, M> {
    type Plan<'p> = StepEnds<'p>;

    fn plan<'p>(simulator: &Simulator, steps: Steps<'p>) -> StepEnds<'p> {
        let schedule = steps.schedule;
        let at_instants = schedule.ending_at(Instants::of(simulator));
        StepEnds { schedule, ends: at_instants.ends(), at_events: at_instants.at_events().to_vec() }
    }

    fn width(&self) -> usize {
        self.alive.len()
    }

    fn samples(&self) -> Vec<usize> {
        (self.first..self.first + self.count).collect()
    }

    /// Lanes stop whose state is no longer finite.
    fn reach(&mut self, plan: &StepEnds<'_>, row: usize, asked: &mut StepInterruption<'s>) -> Vec<Stop> {
        if M::IS_JET && !self.alive.contains(&true) {
            return Vec::new();
        }
        let time = plan.schedule.time(row);
        if row == 0 {
            self.accumulate(0.0);
        }
        self.step_to(plan, time, asked);
        if asked.is_cut() {
            return Vec::new();
        }
        if M::IS_JET
            && let Some(stop) = self.lost_jet(row, time)
        {
            return vec![stop];
        }
        self.rows.as_mut().unwrap_or(&mut self.motion).close(time, &mut self.at_row);
        if let Some(parting) = &mut self.parting {
            let lane = self.at_row.iter().step_by(self.alive.len());
            parting.look(time, lane);
        }
        if M::IS_JET { Vec::new() } else { lost_lanes(&mut self.alive, self.count, &self.at_row, row, time) }
    }

    fn record(&mut self, observed: Observed, into: &mut [f64]) {
        self.rows.as_mut().unwrap_or(&mut self.motion).record(observed, &self.at_row, into);
        forget_lost(&self.alive, into);
    }

    /// Only constraints that open are searched for, in the rows.
    fn watch(&mut self, simulator: &'s Simulator) {
        self.parting = PartingWatch::new(simulator, &simulator.start.layout, self.registers.clone());
    }

    fn reduce(&mut self, channels: &'s [Channel], outputs: usize) {
        self.reduction = Some(Accumulator::new(channels, outputs, self.alive.len()));
    }

    fn reduced(&mut self) -> Vec<f64> {
        self.reduction.as_mut().map(Accumulator::finish).unwrap_or_default()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.parting.as_ref()?.error()
    }
}
