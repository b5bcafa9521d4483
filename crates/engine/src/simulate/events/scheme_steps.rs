//! Steps of HHT-I3 between events, extrapolated over levels: where forces are stiff, the explicit method takes too
//! many.
//!
//! A step is seven equal ones of the scheme on the first level, twice as many on each that follows; levels run on by
//! themselves up to the next event, from the same state (passive extrapolation, as in [`crate::simulate::drive`]).
//! Within the step the motion is the polynomial through the eight states that the levels have in common.

use symdiff::jet::JetSpace;
use symdiff::{JetMemory, Tile, math};

use super::level_stepper::LevelStepper;
use super::stretched::SchemeMotion;
use super::tuning::TUNING;
use crate::numerics::{STEP_NODES, equispaced_weights, largest};
use crate::simulate::drive::{MotionSteps, weights};
use crate::simulate::ensemble::{JetBox, JetStepper};
use crate::simulate::explicit::runge_kutta::{adapted_length, before_event};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, Stepper};

/// The levels of a tile of samples, or of a jet.
#[derive(Debug)]
pub(super) struct SchemeSteps<S> {
    /// Δ: a ≈ w(t + Δh).
    shift: f64,
    levels: Vec<Level<S>>,
    /// Weights of the levels, and of all but the finest.
    weights: Vec<f64>,
    coarser: Vec<f64>,
    time: f64,
    /// State at the end of the step that was tried last.
    next: Vec<f64>,
    /// States that the levels have in common in that step, from its beginning.
    points: Vec<Vec<f64>>,
    /// By how much the finest level changes them, each with that at the beginning first.
    changes: Vec<Vec<f64>>,
    /// Fewer levels, by which others take these steps, if they do.
    judged: Option<Judged>,
    /// Whether the motion begins anew: accelerations of the scheme belong to the first step.
    is_anew: bool,
    rates: Vec<f64>,
}

/// A level, and its state q, v, a, w, λ at the step's beginning, of which a belongs to steps of a length.
#[derive(Debug)]
struct Level<S> {
    stepper: S,
    before: Vec<f64>,
    length: f64,
}

impl<'s> SchemeSteps<Stepper<'s>> {
    /// Steps of an assembled tile, on `levels` levels.
    pub fn of_lanes(simulator: &'s Simulator, start: &Tile, levels: usize) -> Self {
        let mut stepper = Stepper::new(&simulator.program, start);
        stepper.refine(true);
        Self::of(simulator, (0..levels).map(|_| stepper.clone()))
    }
}

impl<'s> SchemeSteps<JetStepper<'s>> {
    /// Steps of a jet about an assembled centre, on `levels` levels.
    pub fn of_jet(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
        center: &Tile,
        start: &JetMemory,
        levels: usize,
    ) -> Self {
        let stepper = |_| {
            let mut stepper = JetStepper::new(simulator, space, about, center, start);
            stepper.center.refine(true);
            stepper
        };
        Self::of(simulator, (0..levels).map(stepper))
    }
}

impl<S: LevelStepper> SchemeSteps<S> {
    fn of(simulator: &Simulator, steppers: impl Iterator<Item = S>) -> Self {
        let levels: Vec<Level<S>> =
            steppers.map(|stepper| Level { before: stepper.save(), stepper, length: f64::NAN }).collect();
        let zero = vec![0.0; levels.first().map_or(0, |level| level.stepper.motion().count())];
        Self {
            shift: simulator.program.coefficients.shift(),
            weights: weights(levels.len()),
            coarser: if levels.len() > 1 { weights(levels.len() - 1) } else { Vec::new() },
            levels,
            time: 0.0,
            next: zero.clone(),
            points: vec![zero.clone(); STEP_NODES],
            changes: vec![zero.clone(); STEP_NODES],
            judged: None,
            is_anew: true,
            rates: zero,
        }
    }

    /// Divides steps so that the first levels err by no more than so much in each unit of time.
    pub fn judge(&mut self, levels: usize, allowed: f64) {
        let changes = vec![0.0; self.next.len()];
        self.judged = Some(Judged { weights: weights(levels), allowed, before: changes.clone(), changes });
    }

    /// Accelerations a of all levels for first steps of a length on the first: w a share Δ of the step later, on the
    /// line through w now and on the side of the events on which the motion goes on.
    fn begin_levels(&mut self, motion: &mut impl SchemeMotion, length: f64) {
        let n = self.next.len() / 2;
        let (of_a, of_w) = (2 * n..3 * n, 3 * n..4 * n);
        for (number, level) in self.levels.iter_mut().enumerate() {
            level.length = length / f64::from(1 << number);
            let share = self.shift.abs() * level.length;
            let known = level.before[of_w.clone()].to_vec();
            let moved = motion.moved(share, &self.points[0], &known);
            motion.rate(self.time + share, &moved, &mut self.rates);
            let behind = &motion.unknowns()[of_w.clone()];
            let shifted = known.iter().zip(behind).map(|(now, behind)| now + self.shift.signum() * (behind - now));
            level.before[of_a.clone()].iter_mut().zip(shifted).for_each(|(value, shifted)| *value = shifted);
        }
    }

    /// Largest change of one line by the finest levels within the step, since its beginning.
    fn change(&self, line: usize) -> f64 {
        let begin = self.changes[0][line];
        largest(self.changes.iter().map(|own| own[line] - begin))
    }

    /// The last term of the polynomial through the states of a line.
    fn last_term(&self, line: usize) -> f64 {
        let last: f64 = self.points.iter().zip(BINOMIALS).map(|(point, weight)| weight * point[line]).sum();
        // Coefficient of the Chebyshev polynomial T₇ given the seventh difference: 7⁷/(7! 2¹³).
        823_543.0 / (5040.0 * 8192.0) * last
    }
}

/// The first levels, and the difference of all levels from them at the beginning of a step and at its end.
#[derive(Debug)]
struct Judged {
    weights: Vec<f64>,
    allowed: f64,
    before: Vec<f64>,
    changes: Vec<f64>,
}

/// Weights of the seventh difference.
const BINOMIALS: [f64; STEP_NODES] = [-1.0, 7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0];

/// Adds a level's positions and velocities times a weight.
fn add(weight: f64, stepper: &impl LevelStepper, to: &mut [f64]) {
    to.iter_mut().zip(stepper.motion()).for_each(|(sum, value)| *sum += weight * value);
}

impl<M: SchemeMotion, S: LevelStepper> MotionSteps<M> for SchemeSteps<S> {
    fn begin(&mut self, motion: &mut M, time: f64, state: &[f64]) {
        (self.time, self.is_anew) = (time, true);
        self.points[0].copy_from_slice(state);
        motion.rate(time, state, &mut self.rates);
        let unknowns = motion.unknowns();
        for level in &mut self.levels {
            level.before.copy_from_slice(&unknowns);
            if let Some(pace) = motion.pace() {
                level.stepper.set_pace(pace);
            }
        }
        self.changes[0].fill(0.0);
        if let Some(judged) = &mut self.judged {
            judged.before.fill(0.0);
        }
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
        let length = (end - self.time) / (STEP_NODES - 1) as f64;
        if self.is_anew {
            self.begin_levels(motion, length);
        }
        self.points[1..].iter_mut().chain(&mut self.changes[1..]).for_each(|point| point.fill(0.0));
        if let Some(judged) = &mut self.judged {
            judged.changes.fill(0.0);
        }
        for (number, level) in self.levels.iter_mut().enumerate() {
            let Level { stepper, before, length: before_length } = level;
            stepper.restart(before, *before_length);
            let steps = 1 << number;
            let h = length / f64::from(steps);
            let weight = self.weights[number];
            let beyond = |others: &[f64]| weight - others.get(number).copied().unwrap_or(0.0);
            let change = beyond(&self.coarser);
            for (part, (point, changed)) in self.points[1..].iter_mut().zip(&mut self.changes[1..]).enumerate() {
                for step in 1..=steps {
                    let done = part as f64 + f64::from(step) / f64::from(steps);
                    let is_last = part + 1 == STEP_NODES - 1 && step == steps;
                    let time = if is_last { end } else { self.time + done * length };
                    stepper.advance(h, time);
                }
                add(weight, stepper, point);
                add(change, stepper, changed);
            }
            if let Some(judged) = &mut self.judged {
                add(beyond(&judged.weights), stepper, &mut judged.changes);
            }
        }
        self.next.copy_from_slice(&self.points[STEP_NODES - 1]);
        motion.close(end, &mut self.next);
        self.points[STEP_NODES - 1].copy_from_slice(&self.next);
        motion.rate(end, &self.next, &mut self.rates);
    }

    fn ratio(&self, _: f64, sizes: &[f64], tolerance: f64) -> f64 {
        let errors = (0..sizes.len()).map(|line| largest([self.change(line), self.last_term(line)]));
        let ratio = largest(errors.zip(sizes).map(|(error, size)| error / (tolerance * size)));
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    }

    fn parts(&self, end: f64, sizes: &[f64]) -> usize {
        let Some(Judged { weights, allowed, before, changes }) = &self.judged else { return 1 };
        let of_line = |((change, before), size): ((&f64, &f64), &f64)| (change - before) / size;
        let error = largest(changes.iter().zip(before).zip(sizes).map(of_line));
        let ratio = error / (allowed * (end - self.time));
        (math::pow(ratio, 1.0 / (weights.len() + 1) as f64).ceil() as usize).clamp(1, TUNING.most_parts_of_step)
    }

    fn shortest(&self) -> f64 {
        1.0 / ((STEP_NODES - 1) << (self.levels.len() - 1)) as f64
    }

    fn counters(&self) -> Counters {
        let mut total = Counters::default();
        self.levels.iter().for_each(|level| total += level.stepper.counters());
        total
    }

    fn next_length(&self, step: f64, ratio: f64) -> f64 {
        adapted_length(step, ratio, self.levels.len() + 1, TUNING.largest_factor_of_levels)
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
        let length = (end - self.time) / (STEP_NODES - 1) as f64;
        (self.time, self.is_anew) = (end, false);
        self.points[0].copy_from_slice(&self.next);
        self.changes.swap(0, STEP_NODES - 1);
        if let Some(judged) = &mut self.judged {
            judged.before.copy_from_slice(&judged.changes);
        }
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
