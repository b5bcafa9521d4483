//! Steps of one motion after another, by whichever method.

use crate::simulate::step::Counters;

/// One step after another of a motion `M`. A step is tried as often as its end changes, until it is accepted.
pub(in crate::simulate) trait MotionSteps<M>: std::fmt::Debug + Send + Sync {
    /// Begins with a state (2n lines) at a time.
    fn begin(&mut self, motion: &mut M, time: f64, state: &[f64]);

    /// The time and the state at the step's beginning.
    fn time(&self) -> f64;
    fn state(&self) -> &[f64];

    /// The state at the end of the step that was tried last.
    fn next(&self) -> &[f64];

    /// Tries a step that ends at a time; the motion was evaluated there last.
    fn attempt(&mut self, motion: &mut M, end: f64);

    /// Largest error over the allowance of the step that was tried, of one lane; `sizes` (2n) are the scales of the
    /// lines, `tolerance` the share of them that a step may err by.
    fn ratio(&self, end: f64, sizes: &[f64], tolerance: f64) -> f64;

    /// Number of equal parts into which other samples with these steps have to divide the step that was tried.
    fn parts(&self, _end: f64, _sizes: &[f64]) -> usize {
        1
    }

    /// The shortest step that was taken, as a share of the step that was tried.
    fn shortest(&self) -> f64;

    /// Length of the next step given that of the one that was tried, and its error over the tolerance: a repetition of
    /// the same step if that is more than 1.
    fn next_length(&self, step: f64, ratio: f64) -> f64;

    /// Prepares [`interpolate`](Self::interpolate) in the step that was tried.
    fn prepare_dense(&mut self, motion: &mut M, end: f64);

    /// The state at a share of the step that was tried; a little more than 1 is beyond its end.
    fn interpolate(&self, share: f64, into: &mut [f64]);

    /// Goes on from the end of the step that was tried, before an event, to a time behind it. Shares stay those of the
    /// step before the event.
    fn extrapolate(&mut self, motion: &mut M, before: f64, end: f64);

    /// Goes on from the end of the step that was tried.
    fn accept(&mut self, motion: &mut M, end: f64);

    /// Goes on from the end of the step that was tried, at which equations have switched.
    fn accept_event(&mut self, motion: &mut M, end: f64);

    /// Newton iterations and rank-revealing solves so far; none of explicit methods.
    fn counters(&self) -> Counters {
        Counters::default()
    }

    /// Tries a step that ends at an event. Returns when its stages end: shares are those of the time up to there.
    fn attempt_to_event(&mut self, motion: &mut M, end: f64) -> f64;
}
