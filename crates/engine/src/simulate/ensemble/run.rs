//! An ensemble of samples on one step schedule: tiles over all cores, advanced row by row of output.

use rayon::prelude::*;

use super::lane_steps::LaneSteps;
use super::observed::{Observed, Stop};
use super::reduction::{Accumulator, Channel};
use super::row_accelerations::RowAccelerations;
use super::tiling::{put_lanes, tiles};
use super::watches::{StepTaken, Watches};
use crate::compile::Tapes;
use crate::numerics::Sample;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::{
    OpenConstraint, OverlapWatch, PartingWatch, SingularPass, SingularWatch, TooDeep, not_finite,
};
use crate::simulate::error::SimulationError;
use crate::simulate::integrator::Integrator;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, StepFailure, Stepper};

/// The run of an ensemble of samples.
#[derive(Debug)]
pub struct EnsembleRun<'s> {
    simulator: &'s Simulator,
    tiles: Vec<TileRun<'s>>,
    samples: usize,
}

#[derive(Debug)]
struct TileRun<'s> {
    simulator: &'s Simulator,
    stepper: Stepper<'s>,
    observes_accelerations: bool,
    /// Where constraints disturb those of the steps.
    accelerations: Option<RowAccelerations<'s>>,
    /// First sample of the tile, and how many of its lanes are samples.
    first: usize,
    count: usize,
    /// Where states change at instants.
    sampling: Option<Sampling<'s>>,
    /// With a tolerance: keeps all lanes within it.
    lanes: Option<LaneSteps<'s>>,
    /// The first row before which a lane's local errors add up to more than the tolerance, or its steps pass over a
    /// feature.
    beyond: Option<usize>,
    watches: Watches<'s>,
    /// Whether the first rows were advanced to.
    begun: bool,
    /// The first of the samples that stopped, and its state at the beginning of the failed step.
    stopped: Option<(usize, Vec<f64>)>,
    /// Where outputs are reduced to one number.
    reduction: Option<Accumulator<'s>>,
    interruption: Interruption<'s>,
    /// Whether it ended at an interruption.
    is_cut: bool,
}

impl<'s> EnsembleRun<'s> {
    /// Assembles samples for a schedule that begins with steps of `first_step`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(simulator: &'s Simulator, samples: &[Sample], first_step: f64) -> Result<Self, SimulationError> {
        let observes_accelerations = simulator.system.observes_accelerations();
        let tiles = tiles(samples.len(), simulator.program.registers(), rayon::current_num_threads());
        let assembled: Vec<Result<TileRun<'s>, SimulationError>> = tiles
            .into_par_iter()
            .map(|(first, count, width)| {
                // Lanes beyond the samples repeat the last one and do not run.
                let sample = |lane: usize| samples[first + lane.min(count - 1)].clone();
                let start = simulator.assemble(width, first_step, sample)?;
                let mut stepper = Stepper::new(&simulator.program, &start);
                stepper.retire(count..width);
                Ok(TileRun {
                    simulator,
                    sampling: Sampling::new(simulator, &start),
                    observes_accelerations,
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
                    interruption: Interruption::default(),
                    is_cut: false,
                })
            })
            .collect();
        let tiles = assembled.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(Self { simulator, tiles, samples: samples.len() })
    }

    /// The term that is no finite number where a sample stopped. Known for the first sample of each tile that stops.
    pub fn not_finite(&self, stop: &Stop) -> Option<String> {
        let mut stopped = self.tiles.iter().filter_map(|tile| tile.stopped.as_ref());
        let (_, state) = stopped.find(|(sample, _)| *sample == stop.sample)?;
        not_finite(&self.simulator.system, &self.simulator.program.layout, state, stop.time)
    }
}

impl<'s> Integrator<'s> for EnsembleRun<'s> {
    fn watch(&mut self) {
        if let Some(tile) = self.tiles.first_mut() {
            let layout = &self.simulator.program.layout;
            tile.watches.singular = Some(SingularWatch::new(self.simulator, &tile.stepper));
            tile.watches.parting = PartingWatch::new(self.simulator, layout, tile.stepper.lane(0));
        }
    }

    fn reduce(&mut self, channels: &'s [Channel]) {
        if !channels.is_empty() {
            let outputs = self.simulator.program.outputs.len();
            for tile in &mut self.tiles {
                tile.reduction = Some(Accumulator::new(channels, outputs, tile.stepper.tile().width()));
            }
        }
    }

    fn heed(&mut self, interruption: Interruption<'s>) {
        self.tiles.iter_mut().for_each(|tile| tile.interruption = interruption);
    }

    fn is_cut(&self) -> bool {
        self.tiles.iter().any(|tile| tile.is_cut)
    }

    fn advance(
        &mut self,
        steps: Steps<'_>,
        rows: std::ops::Range<usize>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        let outputs = observed.count(self.simulator);
        let parts: Vec<(Vec<f64>, Vec<Stop>)> =
            self.tiles.par_iter_mut().map(|tile| tile.advance(steps, rows.clone(), observed, outputs)).collect();
        into.clear();
        into.resize(rows.len() * outputs * self.samples, 0.0);
        let mut stops = Vec::new();
        for (tile, (values, stopped)) in self.tiles.iter().zip(parts) {
            let width = tile.stepper.tile().width();
            put_lanes(&values, width, tile.first..tile.first + tile.count, into, self.samples);
            stops.extend(stopped);
        }
        stops
    }

    fn reduced(&mut self) -> Vec<f64> {
        let mut values = Vec::new();
        for tile in &mut self.tiles {
            let Some(reduction) = &mut tile.reduction else { continue };
            let found = reduction.finish();
            let width = tile.stepper.tile().width();
            values.resize(found.len() / width * self.samples, f64::NAN);
            put_lanes(&found, width, tile.first..tile.first + tile.count, &mut values, self.samples);
        }
        values
    }

    fn counters(&self) -> Counters {
        let mut total = Counters::default();
        self.tiles.iter().for_each(|tile| total += tile.stepper.counters());
        total
    }

    fn singular_passes(&self) -> Vec<SingularPass> {
        self.tiles.iter().filter_map(|tile| tile.watches.singular.as_ref()).flat_map(SingularWatch::passes).collect()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.tiles.iter().find_map(|tile| tile.watches.parting.as_ref()?.error())
    }

    fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint> {
        let mut stopped = self.tiles.iter().filter_map(|tile| tile.stopped.as_ref());
        let (_, state) = stopped.find(|(sample, _)| *sample == stop.sample)?;
        // A residual needs time to grow.
        let times = [stop.time, stop.time + schedule.output_step];
        times.into_iter().find_map(|time| self.simulator.open_constraint(state, time))
    }

    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.tiles.iter().filter_map(|tile| tile.beyond).min()
    }

    fn too_deep(&self) -> Option<TooDeep> {
        let found = self.tiles.iter().filter_map(|tile| tile.watches.overlaps.as_ref()?.found());
        found.min_by(|a, b| a.time.total_cmp(&b.time))
    }

    fn largest_error_ratio(&self) -> Option<(usize, f64)> {
        let ratios = self.tiles.iter().flat_map(|tile| {
            let ratios = tile.lanes.as_ref().map_or(&[][..], |lanes| &lanes.error_ratios()[..tile.count]);
            ratios.iter().enumerate().map(|(lane, &ratio)| (tile.first + lane, ratio))
        });
        ratios.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

impl TileRun<'_> {
    fn advance(
        &mut self,
        steps: Steps<'_>,
        rows: std::ops::Range<usize>,
        observed: Observed,
        outputs: usize,
    ) -> (Vec<f64>, Vec<Stop>) {
        let Steps { schedule, controller } = steps;
        let width = self.stepper.tile().width();
        if !std::mem::replace(&mut self.begun, true) {
            self.accelerations = RowAccelerations::new(self.simulator, self.stepper.tile(), controller.is_some());
            self.lanes = controller.map(|controller| {
                LaneSteps::new(self.simulator, controller, &mut self.stepper).heeding(self.interruption)
            });
            self.watches.begin_rows(self.simulator, &self.stepper, observed, controller.is_some());
        }
        let mut values = vec![0.0; rows.len() * outputs * width];
        let mut stops = Vec::new();
        let mut taken = 0;
        for (index, row) in rows.enumerate() {
            if row == 0 {
                self.reduce(0.0);
            }
            let instants = Instants::of(self.simulator);
            let mut steps = schedule.steps_to(row).flat_map(|(h, end)| instants.divide(h, end)).peekable();
            while let Some((h, end)) = steps.next() {
                if !self.stepper.alive().contains(&true) {
                    break;
                }
                self.is_cut |= self.interruption.is_asked_in(taken);
                if self.is_cut {
                    return (values, stops);
                }
                taken += 1;
                self.stepper.set_step_size(h);
                let is_observed = steps.peek().is_none() || self.reduction.is_some();
                self.stepper.refine(self.observes_accelerations && is_observed);
                self.watches.begin(&self.stepper);
                let failures = match &mut self.lanes {
                    Some(lanes) => lanes.step(&mut self.stepper, h, end),
                    None => self.stepper.step(h, end),
                };
                if self.lanes.as_ref().is_some_and(LaneSteps::is_cut) {
                    self.is_cut = true;
                    return (values, stops);
                }
                if let (Some(first), None) = (failures.first(), &self.stopped) {
                    self.stopped = Some((self.first + first.lane, self.stepper.lane(first.lane)));
                }
                let step = StepTaken { h, end, count: self.count, is_divided: self.lanes.is_some() };
                let is_beyond = self.watches.end(&self.stepper, step);
                self.beyond = self.beyond.or(is_beyond.then_some(row));
                self.sample(end);
                self.reduce(end);
                stops.extend(failures.into_iter().map(|StepFailure { lane, time, equation }| Stop {
                    sample: self.first + lane,
                    row,
                    time,
                    equation,
                    open: None,
                    singular: false,
                }));
            }
            let is_beyond = |lanes: &LaneSteps| lanes.error_ratios()[..self.count].iter().any(|&ratio| ratio > 1.0);
            if self.beyond.is_none() && self.lanes.as_ref().is_some_and(is_beyond) {
                self.beyond = Some(row);
            }
            let values = &mut values[index * outputs * width..][..outputs * width];
            match observed {
                Observed::Outputs => self.observe(values),
                Observed::Motion => {
                    let (motion, outputs) = values.split_at_mut(2 * self.stepper.coordinates() * width);
                    self.stepper.copy_motion(motion);
                    self.observe(outputs);
                }
                Observed::Coordinates => self.stepper.copy_motion(values),
                Observed::Switches => {
                    let (motion, extents) = values.split_at_mut(2 * self.stepper.coordinates() * width);
                    self.stepper.copy_motion(motion);
                    if let Some(switches) = &mut self.watches.switches {
                        switches.take(extents);
                    }
                }
            }
        }
        (values, stops)
    }

    /// Lets the states change that do so at this time.
    fn sample(&mut self, time: f64) {
        let has_changed = self.sampling.as_mut().is_some_and(|sampling| sampling.end(&mut self.stepper, time));
        if let Some(lanes) = self.lanes.as_mut().filter(|_| has_changed) {
            lanes.begin_anew(&self.stepper);
        }
    }

    /// Accumulates the outputs' reductions, if any.
    fn reduce(&mut self, time: f64) {
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
