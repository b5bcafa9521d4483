//! Extrapolation: runs with steps h, h/2, h/4, … combined so that the leading terms of their errors cancel.
//!
//! The scheme's error at a time is a h² + b h³ + c h⁴ + …: it is not even in h, since the algorithmic acceleration
//! belongs to a time beside the step's end. So L levels have the combination
//!
//! ```text
//! T₁(h) = run with h        T_{k+1}(h) = (2^{k+1} T_k(h/2) − T_k(h)) / (2^{k+1} − 1)
//! ```
//!
//! and T_L is of order L + 1. Positions and velocities are combined, all of them, and closed
//! ([`RowClosure`](super::row_closure::RowClosure)); what else a row has follows from them. Levels run on by themselves
//! (passive extrapolation), so that a stiff part is damped in each as it is in one.

use rayon::prelude::*;
use symdiff::{WIDTHS, jet::JetSpace};

use super::jet_states::JetBox;
use super::jets::JetRun;
use super::observed::{Observed, Stop};
use super::reduction::Channel;
use super::row_closure::{JetClosure, RowClosure};
use super::run::EnsembleRun;
use super::tiling::put_lanes;
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::{OpenConstraint, SingularPass, TooDeep};
use crate::simulate::error::SimulationError;
use crate::simulate::integrator::{Integrator, JetIntegrator};
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

/// The run of an ensemble of samples on several levels.
#[derive(Debug)]
pub struct ExtrapolatedRun<'s> {
    simulator: &'s Simulator,
    /// With the steps of the schedule, halved, halved again, …
    levels: Vec<EnsembleRun<'s>>,
    weights: Vec<f64>,
    /// For every so many samples.
    closures: Vec<RowClosure<'s>>,
    samples: usize,
    values: Vec<Vec<f64>>,
    motion: Vec<f64>,
}

impl<'s> ExtrapolatedRun<'s> {
    /// Assembles samples for a schedule that begins with steps of `first_step`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        samples: &[Sample],
        first_step: f64,
        levels: usize,
    ) -> Result<Self, SimulationError> {
        let of_level = |level: u32| EnsembleRun::start(simulator, samples, first_step / f64::from(1_u32 << level));
        let closure = |samples: &[Sample]| {
            let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
            let start = simulator.assemble(width, first_step, |lane| samples[lane.min(samples.len() - 1)].clone())?;
            RowClosure::new(simulator, &start)
        };
        Ok(Self {
            simulator,
            levels: (0..levels as u32).map(of_level).collect::<Result<_, _>>()?,
            weights: weights(levels),
            closures: samples.chunks(TUNING.extrapolated_width).map(closure).collect::<Result<_, _>>()?,
            samples: samples.len(),
            values: vec![Vec::new(); levels],
            motion: Vec::new(),
        })
    }
}

impl<'s> Integrator<'s> for ExtrapolatedRun<'s> {
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
        self.levels.iter().any(EnsembleRun::is_cut)
    }

    fn advance(
        &mut self,
        steps: Steps<'_>,
        rows: std::ops::Range<usize>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
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
        let (samples, motion) = (self.samples, &self.motion);
        let lines = observed.count(self.simulator);
        let parts: Vec<Vec<f64>> = self
            .closures
            .par_iter_mut()
            .enumerate()
            .map(|(index, closure)| {
                let lanes = Lanes { motion, samples, first: index * TUNING.extrapolated_width };
                closed(closure, schedule, rows.clone(), observed, lines, lanes)
            })
            .collect();
        into.clear();
        into.resize(rows.len() * lines * samples, 0.0);
        for (index, values) in parts.iter().enumerate() {
            let first = index * TUNING.extrapolated_width;
            let width = self.closures[index].tile().width();
            put_lanes(values, width, first..(first + TUNING.extrapolated_width).min(samples), into, samples);
        }
        stops
    }

    /// What the levels' outputs are reduced to, combined as their motions are.
    fn reduced(&mut self) -> Vec<f64> {
        let of_levels: Vec<Vec<f64>> = self.levels.iter_mut().map(EnsembleRun::reduced).collect();
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
        self.levels.first().map(EnsembleRun::singular_passes).unwrap_or_default()
    }

    fn parted(&self) -> Option<SimulationError> {
        self.levels.first().and_then(EnsembleRun::parted)
    }

    fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint> {
        self.levels.iter().find_map(|level| level.open_constraint(stop, schedule))
    }

    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.levels.iter().filter_map(EnsembleRun::beyond_tolerance_from).min()
    }

    fn too_deep(&self) -> Option<TooDeep> {
        self.levels.first().and_then(EnsembleRun::too_deep)
    }

    fn largest_error_ratio(&self) -> Option<(usize, f64)> {
        let ratios = self.levels.iter().filter_map(EnsembleRun::largest_error_ratio);
        ratios.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

/// Lanes of a motion.
#[derive(Clone, Copy)]
struct Lanes<'m> {
    /// Row, line, sample.
    motion: &'m [f64],
    samples: usize,
    /// The sample in the first lane.
    first: usize,
}

/// Observed values in rows: row, line, lane.
fn closed(
    closure: &mut RowClosure,
    schedule: &Schedule,
    rows: std::ops::Range<usize>,
    observed: Observed,
    lines: usize,
    Lanes { motion, samples, first }: Lanes<'_>,
) -> Vec<f64> {
    let width = closure.tile().width();
    let of_row = motion.len() / rows.len().max(1);
    let mut state = vec![0.0; of_row / samples.max(1) * width];
    let mut values = vec![0.0; rows.len() * lines * width];
    // A mechanism that is held has no coordinates, but outputs.
    for (index, row) in rows.enumerate() {
        let motion = &motion[index * of_row..][..of_row];
        let values = &mut values[index * lines * width..][..lines * width];
        for (state, line) in state.chunks_exact_mut(width).zip(motion.chunks_exact(samples)) {
            for (lane, value) in state.iter_mut().enumerate() {
                *value = line[(first + lane).min(samples - 1)];
            }
        }
        closure.close(schedule.time(row), &mut state);
        closure.record(observed, &state, values);
    }
    values
}

/// The run of one jet on several levels.
#[derive(Debug)]
pub struct ExtrapolatedJets<'s> {
    simulator: &'s Simulator,
    levels: Vec<JetRun<'s>>,
    weights: Vec<f64>,
    closure: JetClosure<'s>,
    coordinates: usize,
    values: Vec<Vec<f64>>,
    motion: Vec<f64>,
}

impl<'s> ExtrapolatedJets<'s> {
    /// Assembles the jet around `center`; the parameters' half widths are its first derivatives.
    ///
    /// # Errors
    /// Where the centre cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
        first_step: f64,
        levels: usize,
    ) -> Result<Self, SimulationError> {
        let of_level = |level: u32| JetRun::start(simulator, space, about, first_step / f64::from(1_u32 << level));
        let start = simulator.assemble(1, first_step, |_| about.center.iter().copied().collect())?;
        Ok(Self {
            simulator,
            levels: (0..levels as u32).map(of_level).collect::<Result<_, _>>()?,
            weights: weights(levels),
            closure: JetClosure::new(simulator, space, about, &start)?,
            coordinates: simulator.system.q.len(),
            values: vec![Vec::new(); levels],
            motion: Vec::new(),
        })
    }
}

impl<'s> JetIntegrator<'s> for ExtrapolatedJets<'s> {
    fn heed(&mut self, interruption: Interruption<'s>) {
        self.levels.iter_mut().for_each(|level| level.heed(interruption));
    }

    fn is_cut(&self) -> bool {
        self.levels.iter().any(JetRun::is_cut)
    }

    fn advance(&mut self, schedule: &Schedule, rows: std::ops::Range<usize>, into: &mut Vec<f64>) -> Option<Stop> {
        let mut stop: Option<Stop> = None;
        let schedule = &*schedule.ending_at(Instants::of(self.simulator));
        let mut reached = rows.end;
        for (level, (run, values)) in self.levels.iter_mut().zip(&mut self.values).enumerate() {
            let found = run.advance_motion(&schedule.refined(1 << level), rows.start..reached, values);
            reached = found.as_ref().map_or(reached, |stop| stop.row);
            stop = found.or(stop);
        }
        if self.is_cut() {
            return stop;
        }
        let rows = rows.start..reached;
        let shortest = self.values.iter().map(Vec::len).min().unwrap_or(0);
        self.values.iter_mut().for_each(|values| values.truncate(shortest));
        combined(&self.weights, &self.values, &mut self.motion);
        into.clear();
        let of_row = self.motion.len() / rows.len().max(1);
        debug_assert!(of_row.is_multiple_of(2 * self.coordinates));
        for (row, motion) in rows.zip(self.motion.chunks_exact_mut(of_row.max(1))) {
            self.closure.close(schedule.time(row), motion);
            self.closure.observe(into);
        }
        stop
    }

    fn counters(&self) -> Counters {
        let mut total = Counters::default();
        self.levels.iter().for_each(|level| total += level.counters());
        total
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
