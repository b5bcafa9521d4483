//! Samples over a schedule whose steps pass over its rows.

use rayon::prelude::*;
use symdiff::WIDTHS;

use super::runge_kutta::{Motion, RungeKutta};
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::PartingWatch;
use crate::simulate::ensemble::{Accumulator, Channel, Observed, RowClosure, Stop, put_lanes, stops_of_lost};
use crate::simulate::error::SimulationError;
use crate::simulate::integrator::Integrator;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

impl Motion for RowClosure<'_> {
    fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]) {
        RowClosure::rate(self, time, state, into);
    }

    fn close(&mut self, time: f64, state: &mut [f64]) {
        RowClosure::close(self, time, state);
    }

    fn sample(&mut self, time: f64, state: &mut [f64]) -> bool {
        RowClosure::sample(self, time, state)
    }
}

/// A tile of samples between two steps.
#[derive(Debug)]
pub(super) struct Tile<'s> {
    pub motion: RowClosure<'s>,
    /// Of rows, whose accelerations are those of their own states.
    rows: RowClosure<'s>,
    pub run: RungeKutta,
    /// The state at the start.
    pub start: Vec<f64>,
    /// First sample, and how many lanes are samples.
    pub first: usize,
    pub count: usize,
    /// Ends of the steps that are taken.
    steps: usize,
    /// Lanes that still run.
    pub alive: Vec<bool>,
    /// Where outputs are reduced to one number.
    reduction: Option<Accumulator<'s>>,
    interruption: Interruption<'s>,
    /// Whether it ended at an interruption.
    is_cut: bool,
    /// Search for constraints that the first lane leaves open.
    parting: Option<PartingWatch<'s>>,
}

/// Samples in tiles for so many threads, assembled.
pub(super) fn tiles<'s>(
    simulator: &'s Simulator,
    samples: &[Sample],
    threads: usize,
) -> Result<Vec<Tile<'s>>, SimulationError> {
    let at_once = samples.len().div_ceil(threads.max(1)).clamp(1, TUNING.run_width);
    let at_once = WIDTHS.into_iter().find(|&width| width >= at_once).unwrap_or(TUNING.run_width);
    let of_tile = |(index, samples): (usize, &[Sample])| {
        let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
        let start = simulator.assemble(width, 0.0, |lane| samples[lane.min(samples.len() - 1)].clone())?;
        let mut motion = RowClosure::new(simulator, &start)?;
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let run = RungeKutta::start(&mut motion, 0.0, state.clone());
        let rows = RowClosure::new(simulator, &start)?;
        let alive = vec![true; width];
        Ok(Tile {
            motion,
            rows,
            run,
            start: state,
            first: index * at_once,
            count: samples.len(),
            steps: 0,
            alive,
            reduction: None,
            interruption: Interruption::default(),
            is_cut: false,
            parting: None,
        })
    };
    let chunks: Vec<(usize, &[Sample])> = samples.chunks(at_once).enumerate().collect();
    chunks.into_par_iter().map(of_tile).collect()
}

/// The run of an ensemble of samples.
#[derive(Debug)]
pub struct ExplicitRun<'s> {
    simulator: &'s Simulator,
    tiles: Vec<Tile<'s>>,
    samples: usize,
}

impl<'s> ExplicitRun<'s> {
    /// Assembles samples.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(simulator: &'s Simulator, samples: &[Sample]) -> Result<Self, SimulationError> {
        let tiles = tiles(simulator, samples, rayon::current_num_threads())?;
        Ok(Self { simulator, tiles, samples: samples.len() })
    }
}

impl<'s> Integrator<'s> for ExplicitRun<'s> {
    /// Only constraints that open are searched for, in the rows.
    fn watch(&mut self) {
        if let Some(tile) = self.tiles.first_mut() {
            let layout = tile.rows.layout();
            let state = (0..layout.registers()).map(|register| tile.rows.tile().lane(register)[0]).collect();
            tile.parting = PartingWatch::new(self.simulator, layout, state);
        }
    }

    fn reduce(&mut self, channels: &'s [Channel]) {
        let outputs = self.simulator.program.outputs.len();
        for tile in self.tiles.iter_mut().filter(|_| !channels.is_empty()) {
            tile.reduction = Some(Accumulator::new(channels, outputs, tile.alive.len()));
        }
    }

    fn heed(&mut self, interruption: Interruption<'s>) {
        self.tiles.iter_mut().for_each(|tile| tile.interruption = interruption);
    }

    fn is_cut(&self) -> bool {
        self.tiles.iter().any(|tile| tile.is_cut)
    }

    /// Samples stop whose state is no longer finite.
    fn advance(
        &mut self,
        steps: Steps<'_>,
        rows: std::ops::Range<usize>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        let schedule = steps.schedule;
        let lines = observed.count(self.simulator);
        let ends = schedule.ending_at(Instants::of(self.simulator)).ends();
        let parts: Vec<(Vec<f64>, Vec<Stop>)> = self
            .tiles
            .par_iter_mut()
            .map(|tile| tile.advance(schedule, &ends, rows.clone(), observed, lines))
            .collect();
        into.clear();
        into.resize(rows.len() * lines * self.samples, 0.0);
        let mut stops = Vec::new();
        for (tile, (values, stopped)) in self.tiles.iter().zip(parts) {
            put_lanes(&values, tile.alive.len(), tile.first..tile.first + tile.count, into, self.samples);
            stops.extend(stopped);
        }
        stops
    }

    fn reduced(&mut self) -> Vec<f64> {
        let mut values = Vec::new();
        for tile in &mut self.tiles {
            let Some(reduction) = &mut tile.reduction else { continue };
            let (found, width) = (reduction.finish(), tile.alive.len());
            values.resize(found.len() / width * self.samples, f64::NAN);
            put_lanes(&found, width, tile.first..tile.first + tile.count, &mut values, self.samples);
        }
        values
    }

    fn parted(&self) -> Option<SimulationError> {
        self.tiles.iter().find_map(|tile| tile.parting.as_ref()?.error())
    }
}

impl Tile<'_> {
    fn advance(
        &mut self,
        schedule: &Schedule,
        ends: &[f64],
        rows: std::ops::Range<usize>,
        observed: Observed,
        lines: usize,
    ) -> (Vec<f64>, Vec<Stop>) {
        let width = self.alive.len();
        let mut values = vec![0.0; rows.len() * lines * width];
        let mut stops = Vec::new();
        let mut state = vec![0.0; self.run.state.len()];
        for (row, of_row) in rows.zip(values.chunks_exact_mut((lines * width).max(1))) {
            let time = schedule.time(row);
            let Self { motion, rows, run, steps, alive, reduction, interruption, is_cut, .. } = self;
            if row == 0 {
                let mut start = run.state.clone();
                reduce(reduction, rows, alive, 0.0, &mut start);
            }
            let mut between = vec![0.0; if reduction.is_some() { state.len() } else { 0 }];
            let mut taken = 0;
            let mut stepped = |run: &mut RungeKutta, motion: &mut RowClosure, end: f64| {
                if reduction.is_some() {
                    run.prepare_dense(motion, end);
                    for part in 1..=TUNING.places_of_reduced {
                        let share = part as f64 / TUNING.places_of_reduced as f64;
                        run.interpolate(share, &mut between);
                        reduce(reduction, rows, alive, run.time + share * (end - run.time), &mut between);
                    }
                }
                taken += 1;
                *is_cut |= interruption.is_asked_in(taken);
                !*is_cut
            };
            reach(run, motion, steps, ends, time, &mut state, &mut stepped);
            self.is_cut |= self.interruption.is_asked_in(row);
            if self.is_cut {
                return (values, stops);
            }
            self.rows.close(time, &mut state);
            if let Some(parting) = &mut self.parting {
                let (layout, tile) = (self.rows.layout(), self.rows.tile());
                let read = |into: &mut Vec<f64>| {
                    (layout.q.start..layout.v.end).for_each(|register| into[register] = tile.lane(register)[0]);
                };
                parting.look(time, read);
            }
            self.rows.record(observed, &state, of_row);
            stops.extend(stops_of_lost(
                &mut self.alive,
                self.first..self.first + self.count,
                &state,
                row,
                time,
                of_row,
            ));
        }
        (values, stops)
    }
}

/// Accumulates the reductions of a state's outputs, if any.
fn reduce(reduction: &mut Option<Accumulator>, rows: &mut RowClosure, alive: &[bool], time: f64, state: &mut [f64]) {
    if let Some(reduction) = reduction {
        let mut values = reduction.buffer();
        rows.close(time, state);
        rows.observe(&mut values);
        reduction.push(time, values, alive);
    }
}

/// Action after a step, given its end; whether to go on.
type Stepped<'f, M> = dyn FnMut(&mut RungeKutta, &mut M, f64) -> bool + 'f;

/// The state at a time, after those steps of a list that lead to it; a step that passes it stays open. `stepped` is
/// called after each, before the run goes on from its end; where it says so, the run goes no further.
pub(super) fn reach<M: Motion>(
    run: &mut RungeKutta,
    motion: &mut M,
    steps: &mut usize,
    ends: &[f64],
    time: f64,
    state: &mut [f64],
    stepped: &mut Stepped<'_, M>,
) {
    // `steps` counts the steps that are begun; the last of them is open until a row lies beyond its end.
    while time > run.time {
        let open = steps.checked_sub(1).map(|last| ends[last]).filter(|&end| end > run.time);
        let end = match open {
            Some(end) => end,
            None => {
                let Some(&end) = ends.get(*steps) else { break };
                *steps += 1;
                run.attempt(motion, end);
                run.finish(motion, end);
                if !stepped(run, motion, end) {
                    return;
                }
                if time < end {
                    run.prepare_dense(motion, end);
                }
                end
            }
        };
        if time < end {
            run.interpolate((time - run.time) / (end - run.time), state);
            return;
        }
        run.accept(motion, end);
    }
    state.copy_from_slice(&run.state);
}
