//! Stepper of one level of the scheme.

use crate::simulate::ensemble::JetStepper;
use crate::simulate::step::{Counters, Pace, Stepper};

/// Takes the steps of a level: for lanes, or for a jet.
pub(super) trait LevelStepper: std::fmt::Debug + Send + Sync {
    /// q, v, a, w, λ.
    fn save(&self) -> Vec<f64>;

    /// Goes on from a saved state, whose a belongs to steps of length h.
    fn restart(&mut self, saved: &[f64], h: f64);

    /// Gives lanes, or the jet, times of their own.
    fn set_pace(&mut self, pace: &Pace);

    /// Takes a step; lanes that do not converge have no numbers afterwards.
    fn advance(&mut self, h: f64, end: f64);

    /// Newton iterations and rank-revealing solves so far.
    fn counters(&self) -> Counters;

    /// Positions and velocities.
    fn motion(&self) -> impl Iterator<Item = &f64>;
}

impl LevelStepper for Stepper<'_> {
    fn save(&self) -> Vec<f64> {
        Stepper::save(self)
    }

    fn restart(&mut self, saved: &[f64], h: f64) {
        Stepper::restart(self, saved, h);
    }

    fn set_pace(&mut self, pace: &Pace) {
        Stepper::set_pace(self, pace);
    }

    fn advance(&mut self, h: f64, end: f64) {
        self.advance_or_lose(h, end);
    }

    fn counters(&self) -> Counters {
        Stepper::counters(self)
    }

    fn motion(&self) -> impl Iterator<Item = &f64> {
        Stepper::motion(self).iter()
    }
}

impl LevelStepper for JetStepper<'_> {
    fn save(&self) -> Vec<f64> {
        JetStepper::save(self)
    }

    fn restart(&mut self, saved: &[f64], h: f64) {
        JetStepper::restart(self, saved, h);
    }

    fn set_pace(&mut self, pace: &Pace) {
        JetStepper::set_pace(self, pace);
    }

    fn advance(&mut self, h: f64, end: f64) {
        if self.step(h, end).is_err() {
            self.lose();
        }
    }

    fn counters(&self) -> Counters {
        self.center.counters()
    }

    fn motion(&self) -> impl Iterator<Item = &f64> {
        JetStepper::motion(self)
    }
}
