//! Extrapolation: runs with steps h, h/2, h/4, … combined so that the leading terms of their errors cancel.
//!
//! The scheme's error at a time is a h² + b h³ + c h⁴ + …: it is not even in h, since the algorithmic acceleration
//! belongs to a time near the step's end. So L levels have the combination
//!
//! ```text
//! T₁(h) = run with h        T_{k+1}(h) = (2^{k+1} T_k(h/2) − T_k(h)) / (2^{k+1} − 1)
//! ```
//!
//! and T_L is of order L + 1. Positions and velocities are combined, all of them, and closed ([`RowState`]); the other
//! values of a row follow from them. Levels run on by themselves (passive extrapolation), so that a stiff part is
//! damped in each as it is in one.

use std::ops::Range;

use rayon::prelude::*;

use super::integrator::Integrator;
use super::motion::RowState;
use super::observed::{Observed, Stop};
use super::reduction::Channel;
use super::row_tile::RowTile;
use super::tiled_run::TiledRun;
use super::tiling::put_lanes;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::{OpenConstraint, SingularPass, TooDeep};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// Weights of the levels, the coarsest first.
pub fn weights(levels: usize) -> Vec<f64> {
    let mut weights = vec![1.0];
    for level in 1..levels {
        let power = (1_u32 << (level + 1)) as f64;
        let coarse = weights.iter().copied().chain([0.0]);
        let fine = [0.0].into_iter().chain(weights.iter().copied());
        weights = coarse.zip(fine).map(|(coarse, fine)| (power * fine - coarse) / (power - 1.0)).collect();
    }
    weights
}

/// Sum of values with weights.
fn combined(weights: &[f64], values: &[Vec<f64>], into: &mut Vec<f64>) {
    into.clear();
    into.resize(values.first().map_or(0, Vec::len), 0.0);
    for (weight, values) in weights.iter().zip(values) {
        into.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
    }
}

/// Rows of some samples, or of a jet, with their closure.
#[derive(Debug)]
pub struct ClosedRows<R> {
    /// Numbers of the samples in the first lanes.
    pub samples: Vec<usize>,
    /// Lanes beyond the samples repeat the last one.
    pub closure: R,
}

/// The run of an ensemble of samples, or of one jet, on several levels.
#[derive(Debug)]
pub struct Extrapolated<'s, T, R> {
    simulator: &'s Simulator,
    /// Runs with the steps of the schedule, halved, halved again, …
    levels: Vec<TiledRun<'s, T>>,
    weights: Vec<f64>,
    closures: Vec<ClosedRows<R>>,
    /// Number of samples.
    samples: usize,
    values: Vec<Vec<f64>>,
    motion: Vec<f64>,
}

impl<'s, T: RowTile<'s>, R: RowState> Extrapolated<'s, T, R> {
    /// Runs on `levels` levels; `of_level` gives the run of each by its share of the schedule's steps.
    ///
    /// # Errors
    /// Those of the runs.
    pub fn of(
        simulator: &'s Simulator,
        levels: usize,
        closures: Vec<ClosedRows<R>>,
        of_level: impl Fn(f64) -> Result<TiledRun<'s, T>, SimulationError>,
    ) -> Result<Self, SimulationError> {
        let samples = closures.iter().map(|rows| rows.samples.len()).sum();
        Ok(Self {
            simulator,
            levels: (0..levels).map(|level| of_level(1.0 / (1_u32 << level) as f64)).collect::<Result<_, _>>()?,
            weights: weights(levels),
            closures,
            samples,
            values: vec![Vec::new(); levels],
            motion: Vec::new(),
        })
    }
}

impl<'s, T: RowTile<'s>, R: RowState + Send + std::fmt::Debug> Integrator<'s> for Extrapolated<'s, T, R> {
    fn watch(&mut self) {
        if let Some(first) = self.levels.first_mut() {
            first.watch();
        }
    }

    fn reduce(&mut self, channels: &'s [Channel]) {
        self.levels.iter_mut().for_each(|level| level.reduce(channels));
    }

    fn heed(&mut self, interruption: Interruption<'s>) {
        self.levels.iter_mut().for_each(|level| level.heed(interruption));
    }

    fn is_cut(&self) -> bool {
        self.levels.iter().any(TiledRun::is_cut)
    }

    fn advance(&mut self, steps: Steps<'_>, rows: Range<usize>, observed: Observed, into: &mut Vec<f64>) -> Vec<Stop> {
        let mut stops: Vec<Stop> = Vec::new();
        let schedule = &*steps.schedule.ending_at(Instants::of(self.simulator));
        for (level, (run, values)) in self.levels.iter_mut().zip(&mut self.values).enumerate() {
            let parts = 1 << level;
            let controller = steps.controller.map(|all| all.for_parts(parts));
            let of_level = Steps { schedule: &schedule.refined(parts), controller };
            for stop in run.advance(of_level, rows.clone(), Observed::Coordinates, values) {
                match stops.iter_mut().find(|known| known.sample == stop.sample) {
                    Some(known) if known.row <= stop.row => {}
                    Some(known) => *known = stop,
                    None => stops.push(stop),
                }
            }
        }
        if self.is_cut() {
            return stops;
        }
        combined(&self.weights, &self.values, &mut self.motion);
        let motions = Motions { values: &self.motion, first: rows.start, rows: rows.len(), samples: self.samples };
        let lines = observed.count(self.simulator);
        let of_rows = |own: &mut ClosedRows<R>| own.record(motions, schedule, observed, lines);
        let parts: Vec<Vec<f64>> = self.closures.par_iter_mut().map(of_rows).collect();
        into.clear();
        into.resize(rows.len() * lines * self.samples, 0.0);
        for (ClosedRows { samples, closure }, values) in self.closures.iter().zip(parts) {
            put_lanes(&values, closure.width(), samples, into, self.samples);
        }
        stops
    }

    /// Reduced outputs of the levels, combined as their motions are.
    fn reduced(&mut self) -> Vec<f64> {
        let of_levels: Vec<Vec<f64>> = self.levels.iter_mut().map(TiledRun::reduced).collect();
        let mut values = Vec::new();
        combined(&self.weights, &of_levels, &mut values);
        values
    }

    fn counters(&self) -> Counters {
        let mut total = Counters::default();
        self.levels.iter().for_each(|level| total += level.counters());
        total
    }

    fn singular_passes(&self) -> Vec<SingularPass> {
        self.levels.first().map(TiledRun::singular_passes).unwrap_or_default()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.levels.first().and_then(TiledRun::parted)
    }

    fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint> {
        self.levels.iter().find_map(|level| level.open_constraint(stop, schedule))
    }

    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.levels.iter().filter_map(TiledRun::beyond_tolerance_from).min()
    }

    fn too_deep(&self) -> Option<TooDeep> {
        self.levels.first().and_then(TiledRun::too_deep)
    }

    fn largest_error_ratio(&self) -> Option<(usize, f64)> {
        let ratios = self.levels.iter().filter_map(TiledRun::largest_error_ratio);
        ratios.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

/// Positions and velocities of all samples: row, line, sample.
#[derive(Clone, Copy)]
struct Motions<'m> {
    values: &'m [f64],
    /// The first row.
    first: usize,
    rows: usize,
    samples: usize,
}

impl<R: RowState> ClosedRows<R> {
    /// Observed values, `lines` of each row: row, line, lane.
    fn record(&mut self, motions: Motions<'_>, schedule: &Schedule, observed: Observed, lines: usize) -> Vec<f64> {
        let width = self.closure.width();
        let of_row = motions.values.len() / motions.rows.max(1);
        let mut state = vec![0.0; of_row / motions.samples.max(1) * width];
        let mut values = vec![0.0; motions.rows * lines * width];
        // A fully prescribed mechanism has no coordinates, but outputs.
        for row in 0..motions.rows {
            let motion = &motions.values[row * of_row..][..of_row];
            for (state, line) in state.chunks_exact_mut(width).zip(motion.chunks_exact(motions.samples)) {
                for (lane, value) in state.iter_mut().enumerate() {
                    *value = line[self.samples[lane.min(self.samples.len() - 1)]];
                }
            }
            self.closure.close(schedule.time(motions.first + row), &mut state);
            self.closure.record(observed, &state, &mut values[row * lines * width..][..lines * width]);
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_cancel_the_powers_of_the_error() {
        for levels in 1..=4 {
            let weights = weights(levels);
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for power in 2..=levels as i32 {
                let left: f64 =
                    weights.iter().enumerate().map(|(level, weight)| weight * 0.5_f64.powi(power * level as i32)).sum();
                assert!(left.abs() < 1e-15, "{levels} levels leave {left} of h^{power}");
            }
        }
        assert_eq!(weights(3), [1.0 / 21.0, -12.0 / 21.0, 32.0 / 21.0]);
    }
}
