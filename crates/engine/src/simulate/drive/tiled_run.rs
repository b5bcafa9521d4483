//! Tiles on all cores, advanced row by row of output.

use std::ops::Range;

use rayon::prelude::*;

use super::integrator::Integrator;
use super::observed::{Observed, Stop};
use super::reduction::Channel;
use super::row_tile::RowTile;
use super::tiling::put_lanes;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::{OpenConstraint, SingularPass, TooDeep, not_finite};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::{Interruption, StepInterruption};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// The run of an ensemble of samples, or of one jet, whose coefficients stand for samples then.
#[derive(Debug)]
pub struct TiledRun<'s, T> {
    simulator: &'s Simulator,
    tiles: Vec<Driven<'s, T>>,
    /// Number of samples.
    samples: usize,
}

/// A tile that is driven.
#[derive(Debug)]
struct Driven<'s, T> {
    tile: T,
    /// Numbers of the samples in the first lanes.
    samples: Vec<usize>,
    asked: StepInterruption<'s>,
}

impl<'s, T: RowTile<'s>> TiledRun<'s, T> {
    /// A run of tiles at the start.
    pub fn of(simulator: &'s Simulator, tiles: Vec<T>) -> Self {
        let driven = |tile: T| Driven { samples: tile.samples(), tile, asked: StepInterruption::default() };
        let tiles: Vec<Driven<'s, T>> = tiles.into_iter().map(driven).collect();
        let samples = tiles.iter().map(|driven| driven.samples.len()).sum();
        Self { simulator, tiles, samples }
    }

    /// The tiles.
    fn each(&self) -> impl Iterator<Item = &T> {
        self.tiles.iter().map(|driven| &driven.tile)
    }

    /// Registers of a sample that stopped, at the beginning of its last step. Known for the first of each tile.
    fn stopped(&self, stop: &Stop) -> Option<&[f64]> {
        self.tiles.iter().find_map(|driven| {
            let (lane, state) = driven.tile.stopped()?;
            (driven.samples[lane] == stop.sample).then_some(state)
        })
    }

    /// The term that is no finite number where a sample stopped. Known for the first sample of each tile that stops.
    pub fn not_finite(&self, stop: &Stop) -> Option<String> {
        not_finite(&self.simulator.system, &self.simulator.program.layout, self.stopped(stop)?, stop.time)
    }
}

impl<'s, T: RowTile<'s>> Integrator<'s> for TiledRun<'s, T> {
    fn watch(&mut self) {
        if let Some(first) = self.tiles.first_mut() {
            first.tile.watch(self.simulator);
        }
    }

    fn reduce(&mut self, channels: &'s [Channel]) {
        if !channels.is_empty() {
            let outputs = self.simulator.program.outputs.len();
            self.tiles.iter_mut().for_each(|driven| driven.tile.reduce(channels, outputs));
        }
    }

    fn heed(&mut self, interruption: Interruption<'s>) {
        self.tiles.iter_mut().for_each(|driven| driven.asked = interruption.into());
    }

    fn is_cut(&self) -> bool {
        self.tiles.iter().any(|driven| driven.asked.is_cut())
    }

    fn advance(&mut self, steps: Steps<'_>, rows: Range<usize>, observed: Observed, into: &mut Vec<f64>) -> Vec<Stop> {
        let lines = observed.count(self.simulator);
        let plan = T::plan(self.simulator, steps);
        let advance = |driven: &mut Driven<'s, T>| driven.advance(&plan, rows.clone(), observed, lines);
        let parts: Vec<(Vec<f64>, Vec<Stop>)> = self.tiles.par_iter_mut().map(advance).collect();
        into.clear();
        into.resize(rows.len() * lines * self.samples, 0.0);
        let mut stops = Vec::new();
        for (driven, (values, stopped)) in self.tiles.iter().zip(parts) {
            put_lanes(&values, driven.tile.width(), &driven.samples, into, self.samples);
            stops.extend(stopped.into_iter().map(|stop| Stop { sample: driven.samples[stop.sample], ..stop }));
        }
        stops
    }

    fn reduced(&mut self) -> Vec<f64> {
        let mut values = Vec::new();
        for driven in &mut self.tiles {
            let found = driven.tile.reduced();
            if found.is_empty() {
                continue;
            }
            values.resize(found.len() / driven.tile.width() * self.samples, f64::NAN);
            put_lanes(&found, driven.tile.width(), &driven.samples, &mut values, self.samples);
        }
        values
    }

    fn counters(&self) -> Counters {
        let mut total = Counters::default();
        self.each().for_each(|tile| total += tile.counters());
        total
    }

    fn singular_passes(&self) -> Vec<SingularPass> {
        self.each().flat_map(RowTile::singular_passes).collect()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.each().find_map(RowTile::parted)
    }

    fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint> {
        let state = self.stopped(stop)?;
        // A residual needs time to grow.
        let times = [stop.time, stop.time + schedule.output_step];
        times.into_iter().find_map(|time| self.simulator.open_constraint(state, time))
    }

    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.each().filter_map(RowTile::beyond_tolerance_from).min()
    }

    fn too_deep(&self) -> Option<TooDeep> {
        self.each().filter_map(RowTile::too_deep).min_by(|a, b| a.time.total_cmp(&b.time))
    }

    fn largest_error_ratio(&self) -> Option<(usize, f64)> {
        let ratios = self.tiles.iter().flat_map(|Driven { tile, samples, .. }| samples.iter().zip(tile.error_ratios()));
        ratios.map(|(&sample, &ratio)| (sample, ratio)).reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

impl<'s, T: RowTile<'s>> Driven<'s, T> {
    /// Observed values (row, line, lane), and the lanes that stopped.
    fn advance(
        &mut self,
        plan: &T::Plan<'_>,
        rows: Range<usize>,
        observed: Observed,
        lines: usize,
    ) -> (Vec<f64>, Vec<Stop>) {
        let of_row = lines * self.tile.width();
        let mut values = vec![0.0; rows.len() * of_row];
        let mut stops = Vec::new();
        self.asked.begin();
        self.tile.begin(plan, observed);
        for (index, row) in rows.enumerate() {
            stops.extend(self.tile.reach(plan, row, &mut self.asked));
            if self.asked.is_cut() {
                break;
            }
            self.tile.record(observed, &mut values[index * of_row..][..of_row]);
        }
        (values, stops)
    }
}
