//! A step of the method for states q, v of whatever kind: each of the 2n lines holds values of lanes, or coefficients
//! of a jet.

use symdiff::{Vectorise, math, vectorised};

use super::tableau::{DENSE, FIFTH, Row, STAGES, THIRD, TIMES, WEIGHTS, WITH_DENSE};
use super::tuning::TUNING;
use crate::simulate::drive::{Motion, MotionSteps};

/// Terms of the dense output: the change, two of the ends' rates, and four of all stages.
const TERMS: usize = 3 + DENSE.len();

/// The state between steps, and the stages of the step that was tried last.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct RungeKutta {
    /// Time and state at the step's beginning.
    pub time: f64,
    pub state: Vec<f64>,
    /// State at the step's end, once one was tried.
    pub next: Vec<f64>,
    /// The state of the last stage, whose time is the step's end too.
    last: Vec<f64>,
    rates: Vec<Vec<f64>>,
    dense: Vec<Vec<f64>>,
}

/// Largest error over the allowance, and the stiffness of the step, in one lane.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::simulate) struct StepError {
    /// 1 where the error equals the allowance.
    pub ratio: f64,
    /// h times the largest eigenvalue, as far as the last stages show it.
    pub stiffness: f64,
}

/// Length of the next step of this method, s.
pub(in crate::simulate) fn next_length(step: f64, ratio: f64) -> f64 {
    adapted_length(step, ratio, 8, TUNING.largest_factor)
}

/// Length of the next step, s, given that of the one that was tried, and its error over the allowance: a repetition of
/// the same step if that is more than 1. The error is of an order in the length, which grows by `largest` at most.
pub(in crate::simulate) fn adapted_length(step: f64, ratio: f64, order: usize, largest: f64) -> f64 {
    let factor = TUNING.safety * math::pow(ratio.max(TUNING.least_ratio), -1.0 / order as f64);
    step * match ratio {
        ratio if ratio > 1.0 && ratio.is_infinite() => TUNING.least_factor,
        ratio if ratio > 1.0 => factor.clamp(TUNING.least_factor, TUNING.safety),
        _ => factor.clamp(TUNING.least_factor, largest),
    }
}

/// End of the stages of a step that ends at an event, a little before it: forces may jump there, and stages as late as
/// the step's end are on either side of it by chance.
pub(in crate::simulate) fn before_event(begin: f64, end: f64) -> f64 {
    end - TUNING.before_event * (end - begin)
}

/// End of the stages, and of the dense output, of a step that may end at an event.
pub(in crate::simulate) fn end_of_stages(begin: f64, end: f64, is_at_event: bool) -> f64 {
    if is_at_event { before_event(begin, end) } else { end }
}

impl RungeKutta {
    /// Starts from a state.
    pub fn start(motion: &mut impl Motion, time: f64, state: Vec<f64>) -> Self {
        let size = state.len();
        let mut rates = vec![vec![0.0; size]; WITH_DENSE];
        motion.rate(time, &state, &mut rates[0]);
        let (next, last) = (vec![0.0; size], vec![0.0; size]);
        Self { time, state, next, last, rates, dense: vec![vec![0.0; size]; TERMS] }
    }

    /// The rates of a stage.
    #[cfg(test)]
    pub fn rates(&self, stage: usize) -> &[f64] {
        &self.rates[stage]
    }

    /// Tries a step that ends at a time.
    pub fn attempt(&mut self, motion: &mut impl Motion, end: f64) {
        let h = end - self.time;
        for (stage, (weights, time)) in WEIGHTS.into_iter().zip(TIMES).enumerate().take(STAGES - 1).skip(1) {
            self.combine(weights, h, Place::Last);
            motion.rate(self.time + time * h, &self.last, &mut self.rates[stage]);
        }
        self.combine(WEIGHTS[STAGES - 1], h, Place::Next);
    }

    /// Closes the state at the end of the step that was tried, and evaluates it.
    pub fn finish(&mut self, motion: &mut impl Motion, end: f64) {
        motion.close(end, &mut self.next);
        motion.rate(end, &self.next, &mut self.rates[STAGES - 1]);
    }

    /// Goes on along the dense output of the step that was finished, before an event, to a time behind it, and
    /// evaluates the state there. Shares of the dense output are those of the step before the event.
    pub fn extrapolate(&mut self, motion: &mut impl Motion, before: f64, end: f64) {
        self.prepare_dense(motion, before);
        let mut next = std::mem::take(&mut self.next);
        self.interpolate((end - self.time) / (before - self.time), &mut next);
        self.next = next;
        self.finish(motion, end);
    }

    /// Goes on from the end of the step that was finished.
    pub fn accept(&mut self, motion: &mut impl Motion, end: f64) {
        std::mem::swap(&mut self.state, &mut self.next);
        self.rates.swap(0, STAGES - 1);
        self.time = end;
        if motion.sample(end, &mut self.state) {
            motion.rate(end, &self.state, &mut self.rates[0]);
        }
    }

    /// Makes the dense output of the step that was finished.
    pub fn prepare_dense(&mut self, motion: &mut impl Motion, end: f64) {
        let h = end - self.time;
        for (stage, (weights, time)) in WEIGHTS.into_iter().zip(TIMES).enumerate().skip(STAGES) {
            self.combine(weights, h, Place::Last);
            motion.rate(self.time + time * h, &self.last, &mut self.rates[stage]);
        }
        let (first, others) = self.dense.split_at_mut(3);
        let [change, begin, both] = first else { return };
        let ends = self.state.iter().zip(&self.next).zip(self.rates[0].iter().zip(&self.rates[STAGES - 1]));
        for (((change, begin), both), ((state, next), (old, new))) in change.iter_mut().zip(begin).zip(both).zip(ends) {
            let difference = next - state;
            *change = difference;
            *begin = h * old - difference;
            *both = 2.0 * difference - h * (new + old);
        }
        for (term, weights) in others.iter_mut().zip(DENSE) {
            term.fill(0.0);
            weights.iter().for_each(|&(stage, weight)| {
                vectorised(Add { to: term, values: &self.rates[stage], factor: h * weight })
            });
        }
    }

    /// The state at a share of the step that dense output was made of; a little more than 1 is beyond its end.
    pub fn interpolate(&self, share: f64, into: &mut [f64]) {
        for (index, into) in into.iter_mut().enumerate() {
            let mut value = 0.0;
            for (number, term) in self.dense.iter().rev().enumerate() {
                value = (value + term[index]) * if number % 2 == 0 { share } else { 1.0 - share };
            }
            *into = self.state[index] + value;
        }
    }

    /// Errors of the step that was finished, lane by lane; `sizes` (2n) are the scales of the lines, `tolerance` the
    /// share of them that a step may err by.
    pub fn errors(&self, end: f64, sizes: &[f64], tolerance: f64, width: usize) -> Vec<StepError> {
        let h = end - self.time;
        let error_of = |weights: Row, index: usize| -> f64 {
            weights.iter().map(|&(stage, weight)| weight * self.rates[stage][index]).sum::<f64>()
        };
        let of_lane = |lane: usize| {
            let (mut fifth, mut third, mut rates, mut states) = (0.0, 0.0, 0.0, 0.0);
            for (line, size) in sizes.iter().enumerate() {
                let index = line * width + lane;
                let allowed = tolerance * size;
                fifth = larger(fifth, error_of(FIFTH, index) / allowed);
                third = larger(third, error_of(THIRD, index) / allowed);
                let rate = (self.rates[STAGES - 1][index] - self.rates[STAGES - 2][index]) / size;
                let state = (self.next[index] - self.last[index]) / size;
                rates += rate * rate;
                states += state * state;
            }
            let scale = (fifth * fifth + 0.01 * third * third).sqrt();
            let ratio = if fifth == 0.0 { 0.0 } else { h * fifth * fifth / scale };
            let stiffness = if states > 0.0 { h * (rates / states).sqrt() } else { 0.0 };
            StepError { ratio: if ratio.is_nan() { f64::INFINITY } else { ratio }, stiffness }
        };
        (0..width).map(of_lane).collect()
    }

    /// The state plus h times weighted rates.
    fn combine(&mut self, weights: Row, h: f64, place: Place) {
        let Self { state, next, last, rates, .. } = self;
        let into = if place == Place::Next { next } else { last };
        into.copy_from_slice(state);
        for &(stage, weight) in weights {
            vectorised(Add { to: into, values: &rates[stage], factor: h * weight });
        }
    }
}

impl<M: Motion> MotionSteps<M> for RungeKutta {
    fn begin(&mut self, motion: &mut M, time: f64, state: &[f64]) {
        *self = Self::start(motion, time, state.to_vec());
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn state(&self) -> &[f64] {
        &self.state
    }

    fn next(&self) -> &[f64] {
        &self.next
    }

    fn attempt(&mut self, motion: &mut M, end: f64) {
        RungeKutta::attempt(self, motion, end);
        self.finish(motion, end);
    }

    fn ratio(&self, end: f64, sizes: &[f64], tolerance: f64) -> f64 {
        self.errors(end, sizes, tolerance, 1)[0].ratio
    }

    fn shortest(&self) -> f64 {
        1.0
    }

    fn next_length(&self, step: f64, ratio: f64) -> f64 {
        next_length(step, ratio)
    }

    fn prepare_dense(&mut self, motion: &mut M, end: f64) {
        RungeKutta::prepare_dense(self, motion, end);
    }

    fn interpolate(&self, share: f64, into: &mut [f64]) {
        RungeKutta::interpolate(self, share, into);
    }

    fn extrapolate(&mut self, motion: &mut M, before: f64, end: f64) {
        RungeKutta::extrapolate(self, motion, before, end);
    }

    fn accept(&mut self, motion: &mut M, end: f64) {
        RungeKutta::accept(self, motion, end);
    }

    /// The rates at the end of the step are those behind the event.
    fn accept_event(&mut self, motion: &mut M, end: f64) {
        RungeKutta::accept(self, motion, end);
    }

    fn attempt_to_event(&mut self, motion: &mut M, end: f64) -> f64 {
        let before = before_event(self.time, end);
        MotionSteps::attempt(self, motion, before);
        RungeKutta::extrapolate(self, motion, before, end);
        before
    }
}

/// Target of a combination.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Next,
    Last,
}

/// Written so that NaN wins and stays.
fn larger(so_far: f64, value: f64) -> f64 {
    if value.abs() <= so_far || so_far.is_nan() { so_far } else { value.abs() }
}

/// Adds values times a factor.
struct Add<'a> {
    to: &'a mut [f64],
    values: &'a [f64],
    factor: f64,
}

impl Vectorise for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (to, value) in self.to.iter_mut().zip(self.values) {
            *to += self.factor * value;
        }
    }
}

#[cfg(test)]
mod tests {
    use symdiff::math;

    use super::*;

    /// x'' = −x: one line each of x and v.
    struct Oscillator;

    impl Motion for Oscillator {
        fn rate(&mut self, _: f64, state: &[f64], into: &mut [f64]) {
            (into[0], into[1]) = (state[1], -state[0]);
        }

        fn close(&mut self, _: f64, _: &mut [f64]) {}

        fn sample(&mut self, _: f64, _: &mut [f64]) -> bool {
            false
        }
    }

    #[test]
    fn steps_and_dense_output_have_their_orders() {
        let errors = [0.8, 0.4].map(|h: f64| {
            let mut run = RungeKutta::start(&mut Oscillator, 0.0, vec![1.0, 0.0]);
            run.attempt(&mut Oscillator, h);
            run.finish(&mut Oscillator, h);
            run.prepare_dense(&mut Oscillator, h);
            let mut middle = [0.0; 2];
            run.interpolate(0.37, &mut middle);
            [(run.next[0] - math::cos(h)).abs(), (middle[0] - math::cos(0.37 * h)).abs()]
        });
        let order = |index: usize| math::log2(errors[0][index] / errors[1][index]);
        assert!(order(0) > 8.5 && order(1) > 7.5, "{errors:?}");
    }
}
