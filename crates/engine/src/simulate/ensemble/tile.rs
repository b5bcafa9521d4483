//! A tile of samples under the scheme: its steps end at rows, and a tolerance divides those of the lanes that need it.

use rayon::prelude::*;

use super::lane_steps::LaneSteps;
use super::row_accelerations::RowAccelerations;
use super::watches::{StepTaken, Watches};
use crate::compile::Tapes;
use crate::numerics::Sample;
use crate::simulate::control::Steps;
use crate::simulate::diagnostics::{OverlapWatch, PartingWatch, SingularPass, SingularWatch, TooDeep};
use crate::simulate::drive::{Accumulator, Channel, Observed, RowTile, Stop, TiledRun, tiles};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, StepFailure, Stepper};

/// The run of an ensemble of samples under the scheme.
pub type EnsembleRun<'s> = TiledRun<'s, SchemeTile<'s>>;

/// Samples in lanes.
#[derive(Debug)]
pub struct SchemeTile<'s> {
    simulator: &'s Simulator,
    stepper: Stepper<'s>,
    observes_accelerations: bool,
    /// Solver for accelerations, if constraints disturb those of the steps.
    accelerations: Option<RowAccelerations<'s>>,
    /// First sample of the tile, and how many of its lanes are samples.
    first: usize,
    count: usize,
    /// Sampling, if states change at instants.
    sampling: Option<Sampling<'s>>,
    /// Keeps all lanes within the tolerance, if there is one.
    lanes: Option<LaneSteps<'s>>,
    /// The first row before which a lane's local errors add up to more than the tolerance, or its steps pass over a
    /// feature.
    beyond: Option<usize>,
    watches: Watches<'s>,
    /// Whether the first rows were advanced to.
    begun: bool,
    /// The first lane that stopped, and its state at the beginning of the failed step.
    stopped: Option<(usize, Vec<f64>)>,
    /// Accumulator of outputs that are reduced to one number.
    reduction: Option<Accumulator<'s>>,
}

impl<'s> EnsembleRun<'s> {
    /// Assembles samples for a schedule that begins with steps of `first_step`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(simulator: &'s Simulator, samples: &[Sample], first_step: f64) -> Result<Self, SimulationError> {
        let tiles = tiles(samples.len(), simulator.program.registers(), rayon::current_num_threads());
        let assembled: Vec<Result<SchemeTile<'s>, SimulationError>> = tiles
            .into_par_iter()
            .map(|(first, count, width)| {
                // Lanes beyond the samples repeat the last one and do not run.
                let sample = |lane: usize| samples[first + lane.min(count - 1)].clone();
                let start = simulator.assemble(width, first_step, sample)?;
                let mut stepper = Stepper::new(&simulator.program, &start);
                stepper.retire(count..width);
                Ok(SchemeTile {
                    simulator,
                    sampling: Sampling::new(simulator, &start),
                    observes_accelerations: simulator.system.observes_accelerations(),
                    accelerations: None,
                    begun: false,
                    first,
                    count,
                    lanes: None,
                    beyond: None,
                    watches: Watches {
                        overlaps: simulator.overlaps().map(|program| OverlapWatch::new(program, &stepper)),
                        ..Watches::default()
                    },
                    stepper,
                    stopped: None,
                    reduction: None,
                })
            })
            .collect();
        Ok(Self::of(simulator, assembled.into_iter().collect::<Result<_, _>>()?))
    }
}

impl<'s> RowTile<'s> for SchemeTile<'s> {
    type Plan<'p> = Steps<'p>;

    fn plan<'p>(_: &Simulator, steps: Steps<'p>) -> Steps<'p> {
        steps
    }

    fn width(&self) -> usize {
        self.stepper.tile().width()
    }

    fn samples(&self) -> Vec<usize> {
        (self.first..self.first + self.count).collect()
    }

    fn begin(&mut self, Steps { controller, .. }: &Steps<'_>, observed: Observed) {
        if !std::mem::replace(&mut self.begun, true) {
            self.accelerations = RowAccelerations::new(self.simulator, self.stepper.tile(), controller.is_some());
            self.lanes = controller.map(|controller| LaneSteps::new(self.simulator, controller, &mut self.stepper));
            self.watches.begin_rows(self.simulator, &self.stepper, observed, controller.is_some());
        }
    }

    fn reach(&mut self, plan: &Steps<'_>, row: usize, asked: &mut StepInterruption<'s>) -> Vec<Stop> {
        if row == 0 {
            self.accumulate(0.0);
        }
        let mut stops = Vec::new();
        let mut steps = Instants::of(self.simulator).steps_to(row, plan.schedule).peekable();
        while let Some((h, end)) = steps.next() {
            if !self.stepper.alive().contains(&true) {
                break;
            }
            if asked.ends() {
                return stops;
            }
            self.stepper.set_step_size(h);
            let is_observed = steps.peek().is_none() || self.reduction.is_some();
            self.stepper.refine(self.observes_accelerations && is_observed);
            self.watches.begin(&self.stepper);
            let failures = match &mut self.lanes {
                Some(lanes) => lanes.step(&mut self.stepper, h, end, asked),
                None => self.stepper.step(h, end),
            };
            if asked.is_cut() {
                return stops;
            }
            if let (Some(first), None) = (failures.first(), &self.stopped) {
                self.stopped = Some((first.lane, self.stepper.lane(first.lane)));
            }
            let step = StepTaken { h, end, count: self.count, is_divided: self.lanes.is_some() };
            let is_beyond = self.watches.end(&self.stepper, step);
            self.beyond = self.beyond.or(is_beyond.then_some(row));
            self.sample(end);
            self.accumulate(end);
            let stop = |StepFailure { lane, time, equation }| Stop {
                sample: lane,
                row,
                time,
                equation,
                open: None,
                singular: false,
            };
            stops.extend(failures.into_iter().map(stop));
        }
        if self.beyond.is_none() && self.error_ratios().iter().any(|&ratio| ratio > 1.0) {
            self.beyond = Some(row);
        }
        stops
    }

    fn record(&mut self, observed: Observed, into: &mut [f64]) {
        if observed == Observed::Outputs {
            return self.observe(into);
        }
        let (motion, others) = into.split_at_mut(2 * self.stepper.coordinates() * self.width());
        self.stepper.copy_motion(motion);
        match (observed, &mut self.watches.switches) {
            (Observed::Motion, _) => self.observe(others),
            (Observed::Switches, Some(switches)) => switches.take(others),
            _ => {}
        }
    }

    fn watch(&mut self, simulator: &'s Simulator) {
        self.watches.singular = Some(SingularWatch::new(simulator, &self.stepper));
        self.watches.parting = PartingWatch::new(simulator, &simulator.program.layout, self.stepper.lane(0));
    }

    fn reduce(&mut self, channels: &'s [Channel], outputs: usize) {
        self.reduction = Some(Accumulator::new(channels, outputs, self.width()));
    }

    fn reduced(&mut self) -> Vec<f64> {
        self.reduction.as_mut().map(Accumulator::finish).unwrap_or_default()
    }

    fn counters(&self) -> Counters {
        self.stepper.counters()
    }

    fn singular_passes(&self) -> Vec<SingularPass> {
        self.watches.singular.as_ref().map(SingularWatch::passes).unwrap_or_default()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.watches.parting.as_ref()?.error()
    }

    fn stopped(&self) -> Option<(usize, &[f64])> {
        self.stopped.as_ref().map(|(lane, state)| (*lane, state.as_slice()))
    }

    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.beyond
    }

    fn too_deep(&self) -> Option<TooDeep> {
        self.watches.overlaps.as_ref()?.found()
    }

    fn error_ratios(&self) -> &[f64] {
        self.lanes.as_ref().map_or(&[][..], |lanes| &lanes.error_ratios()[..self.count])
    }
}

impl SchemeTile<'_> {
    /// Lets the states change that do so at this time.
    fn sample(&mut self, time: f64) {
        let has_changed = self.sampling.as_mut().is_some_and(|sampling| sampling.end(&mut self.stepper, time));
        if let Some(lanes) = self.lanes.as_mut().filter(|_| has_changed) {
            lanes.begin_anew(&self.stepper);
        }
    }

    /// Accumulates the outputs' reductions, if any.
    fn accumulate(&mut self, time: f64) {
        if let Some(mut reduction) = self.reduction.take() {
            let mut values = reduction.buffer();
            self.observe(&mut values);
            reduction.push(time, values, self.stepper.alive());
            self.reduction = Some(reduction);
        }
    }

    fn observe(&mut self, into: &mut [f64]) {
        match &mut self.accelerations {
            Some(accelerations) => accelerations.observe(&mut self.stepper, into),
            None => self.stepper.observe(into),
        }
    }
}
