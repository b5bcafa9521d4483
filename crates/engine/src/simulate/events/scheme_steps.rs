//! Steps of HHT-I3 between events, extrapolated over levels: where forces are stiff, the explicit method takes too
//! many.
//!
//! A step is seven equal ones of the scheme on the first level, twice as many on each that follows; levels run on by
//! themselves up to the next event, from the same state (passive extrapolation, as in [`crate::simulate::drive`]).
//! Within the step the motion is the polynomial through the eight states that the levels have in common.

use symdiff::Tile;

use super::stretched::LaneMotion;
use super::tuning::TUNING;
use crate::numerics::{STEP_NODES, equispaced_weights};
use crate::simulate::drive::{MotionSteps, weights};
use crate::simulate::explicit::runge_kutta::before_event;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Stepper;

/// Steps of the first level in one step.
pub(in crate::simulate) const STEPS_OF_SCHEME: usize = STEP_NODES - 1;

/// A tile of samples.
#[derive(Debug)]
pub(super) struct SchemeSteps<'s> {
    simulator: &'s Simulator,
    levels: Vec<Level<'s>>,
    /// Weights of the levels, and of all but the finest.
    weights: Vec<f64>,
    coarser: Vec<f64>,
    time: f64,
    /// At the end of the step that was tried last.
    next: Vec<f64>,
    /// States that the levels have in common in that step, from its beginning.
    points: Vec<Vec<f64>>,
    /// By how much the finest level changes them, each with that at the beginning first.
    changes: Vec<Vec<f64>>,
    /// Whether the motion begins anew: accelerations of the scheme belong to the first step.
    is_anew: bool,
    rates: Vec<f64>,
}

/// A level, and its state q, v, a, w, λ at the step's beginning, of which a belongs to steps of a length.
#[derive(Debug)]
struct Level<'s> {
    stepper: Stepper<'s>,
    before: Vec<f64>,
    length: f64,
}

impl<'s> SchemeSteps<'s> {
    /// Of an assembled tile, on so many levels.
    pub fn new(simulator: &'s Simulator, start: &Tile, levels: usize) -> Self {
        let level = |_| {
            let mut stepper = Stepper::new(&simulator.program, start);
            stepper.refine(true);
            Level { before: stepper.save(), stepper, length: f64::NAN }
        };
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let zero = vec![0.0; state.len()];
        Self {
            simulator,
            levels: (0..levels).map(level).collect(),
            weights: weights(levels),
            coarser: if levels > 1 { weights(levels - 1) } else { Vec::new() },
            time: 0.0,
            next: zero.clone(),
            points: vec![state; STEP_NODES],
            changes: vec![zero.clone(); STEP_NODES],
            is_anew: true,
            rates: zero,
        }
    }

    /// Accelerations a of all levels for first steps of a length on the first: w a share Δ of the step later, on the
    /// line through w now and on the side of the events on which the motion goes on.
    fn begin_levels<M: LaneMotion<'s>>(&mut self, motion: &mut M, length: f64) {
        let (layout, shift) = (&self.simulator.start.layout, self.simulator.program.coefficients.shift());
        let paces = motion.lengths();
        let width = paces.len();
        let n = layout.q.len() * width;
        let now = &self.points[0];
        let known = self.levels[0].before[3 * n..4 * n].to_vec();
        for (number, level) in self.levels.iter_mut().enumerate() {
            level.length = length / f64::from(1 << number);
            let share = shift.abs() * level.length;
            let mut moved = now.clone();
            for index in 0..n {
                let time = share * paces[index % width];
                moved[index] += time * (now[n + index] + 0.5 * time * known[index]);
                moved[n + index] += time * known[index];
            }
            motion.rate(self.time + share, &moved, &mut self.rates);
            let behind = motion.closure().tile().block(layout.w.clone());
            let shifted = known.iter().zip(behind).map(|(now, behind)| now + shift.signum() * (behind - now));
            level.before[2 * n..3 * n].iter_mut().zip(shifted).for_each(|(value, shifted)| *value = shifted);
        }
    }

    /// Largest change by the finest level within the step, since its beginning, and the last term of the polynomial
    /// through its states; of one line.
    fn error_of(&self, line: usize) -> f64 {
        let begin = self.changes[0][line];
        let by_levels = self.changes.iter().map(|own| (own[line] - begin).abs()).fold(0.0, larger);
        let last: f64 = self.points.iter().zip(BINOMIALS).map(|(point, weight)| weight * point[line]).sum();
        larger(by_levels, (LAST_TERM * last).abs())
    }
}

/// Weights of the seventh difference.
const BINOMIALS: [f64; STEP_NODES] = [-1.0, 7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0];

/// Coefficient of the Chebyshev polynomial T₇ on the step, given the seventh difference: 7⁷/(7! 2¹³).
const LAST_TERM: f64 = 823_543.0 / (5040.0 * 8192.0);

/// Written so that NaN wins and stays.
fn larger(so_far: f64, value: f64) -> f64 {
    if value <= so_far || so_far.is_nan() { so_far } else { value }
}

impl<'s, M: LaneMotion<'s>> MotionSteps<M> for SchemeSteps<'s> {
    fn begin(&mut self, motion: &mut M, time: f64, state: &[f64]) {
        let layout = &self.simulator.start.layout;
        (self.time, self.is_anew) = (time, true);
        self.points[0].copy_from_slice(state);
        motion.rate(time, state, &mut self.rates);
        let assembled = motion.closure().tile().block(layout.state());
        self.levels.iter_mut().for_each(|level| level.before.copy_from_slice(assembled));
        self.changes[0].fill(0.0);
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn state(&self) -> &[f64] {
        &self.points[0]
    }

    fn next(&self) -> &[f64] {
        &self.next
    }

    fn attempt(&mut self, motion: &mut M, end: f64) {
        let length = (end - self.time) / STEPS_OF_SCHEME as f64;
        if self.is_anew {
            self.begin_levels(motion, length);
        }
        self.points[1..].iter_mut().chain(&mut self.changes[1..]).for_each(|point| point.fill(0.0));
        let pace = motion.pace();
        for (number, level) in self.levels.iter_mut().enumerate() {
            let Level { stepper, before, length: before_length } = level;
            if let Some(pace) = pace {
                stepper.set_pace(pace);
            }
            stepper.restart(before, *before_length);
            let steps = 1 << number;
            let h = length / f64::from(steps);
            let weight = self.weights[number];
            let change = weight - self.coarser.get(number).copied().unwrap_or(0.0);
            for (part, (point, changed)) in self.points[1..].iter_mut().zip(&mut self.changes[1..]).enumerate() {
                for step in 1..=steps {
                    let done = part as f64 + f64::from(step) / f64::from(steps);
                    let is_last = part + 1 == STEPS_OF_SCHEME && step == steps;
                    let time = if is_last { end } else { self.time + done * length };
                    stepper.advance_or_lose(h, time);
                }
                let motion = stepper.motion();
                point.iter_mut().zip(motion).for_each(|(sum, value)| *sum += weight * value);
                changed.iter_mut().zip(motion).for_each(|(sum, value)| *sum += change * value);
            }
        }
        self.next.copy_from_slice(&self.points[STEPS_OF_SCHEME]);
        motion.close(end, &mut self.next);
        self.points[STEPS_OF_SCHEME].copy_from_slice(&self.next);
        motion.rate(end, &self.next, &mut self.rates);
    }

    fn ratio(&self, end: f64, sizes: &[f64], tolerance: f64) -> f64 {
        let n = sizes.len() / 2;
        let finest = (end - self.time) / (STEPS_OF_SCHEME << (self.levels.len() - 1)) as f64;
        // Positions are rounded, and velocities are those of them over the shortest steps.
        let rounding = |line: usize| {
            let of_position = TUNING.rounding_of_levels * f64::EPSILON * self.next[line % n].abs();
            if line < n { of_position } else { of_position / finest }
        };
        let of_line = |(line, size): (usize, &f64)| self.error_of(line) / (tolerance * size + rounding(line));
        let ratio = sizes.iter().enumerate().map(of_line).fold(0.0, larger);
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    }

    fn next_length(&self, step: f64, ratio: f64) -> f64 {
        let order = self.levels.len() as f64 + 1.0;
        let factor = TUNING.safety_of_levels * ratio.max(f64::MIN_POSITIVE).powf(-1.0 / order);
        let largest = if ratio > 1.0 { TUNING.safety_of_levels } else { TUNING.largest_factor_of_levels };
        step * if ratio.is_finite() { factor.clamp(TUNING.least_factor_of_levels, largest) } else { TUNING.least_share }
    }

    fn prepare_dense(&mut self, _: &mut M, _: f64) {}

    fn interpolate(&self, share: f64, into: &mut [f64]) {
        let weights: [f64; STEP_NODES] = equispaced_weights(share);
        for (line, value) in into.iter_mut().enumerate() {
            *value = weights.iter().zip(&self.points).map(|(weight, point)| weight * point[line]).sum();
        }
    }

    fn extrapolate(&mut self, motion: &mut M, before: f64, end: f64) {
        let mut next = std::mem::take(&mut self.next);
        MotionSteps::<M>::interpolate(self, (end - self.time) / (before - self.time), &mut next);
        motion.close(end, &mut next);
        motion.rate(end, &next, &mut self.rates);
        self.next = next;
    }

    fn accept(&mut self, _: &mut M, end: f64) {
        let length = (end - self.time) / STEPS_OF_SCHEME as f64;
        (self.time, self.is_anew) = (end, false);
        self.points[0].copy_from_slice(&self.next);
        self.changes.swap(0, STEPS_OF_SCHEME);
        for (number, level) in self.levels.iter_mut().enumerate() {
            level.before = level.stepper.save();
            level.length = length / f64::from(1 << number);
        }
    }

    fn accept_event(&mut self, motion: &mut M, end: f64) {
        let state = std::mem::take(&mut self.next);
        self.begin(motion, end, &state);
        self.next = state;
    }

    fn attempt_to_event(&mut self, motion: &mut M, end: f64) -> f64 {
        let before = before_event(self.time, end);
        self.attempt(motion, before);
        self.extrapolate(motion, before, end);
        before
    }
}
