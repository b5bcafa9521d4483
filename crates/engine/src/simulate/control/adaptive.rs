//! Steps whose size follows the local errors of a tile's samples, together.

use symdiff::Expr;

use super::chatter::Chatter;
use super::controller::Controller;
use super::switch_watch::SwitchWatch;
use super::tuning::TUNING;
use crate::simulate::events::locate::Crossing;
use crate::simulate::features::FeatureWatch;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Stepper;

/// The samples in step, and the step size to try next.
///
/// Where the equations switch in a step (a contact closes), the step is repeated so that it ends there. The local error
/// of that step, and of the next until it is small enough, is the whole change of acceleration: the part that stiff
/// forces leave of it says little where a step jumps over their motion.
#[derive(Clone, Debug)]
pub struct Adaptive<'s> {
    pub controller: Controller,
    pub stepper: Stepper<'s>,
    /// The step size to try next, s.
    pub h: f64,
    watch: Option<SwitchWatch<'s>>,
    features: Option<FeatureWatch<'s>>,
    /// Register of the time.
    time: usize,
    /// Lanes whose equations switched in the step before.
    switched: Vec<bool>,
    chatter: Chatter,
}

/// A step that was tried.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// Its length and its end, s.
    pub step: f64,
    pub end: f64,
    /// Every lane's error over its share of the tolerance: infinite where it does not converge, 0 where it no longer
    /// runs.
    pub ratios: Vec<f64>,
    /// Whether the step stands.
    pub accepted: bool,
    before: Vec<f64>,
}

impl<'s> Adaptive<'s> {
    /// Starts from the states of a stepper; the first step tried has the length `h`.
    pub fn new(simulator: &'s Simulator, mut stepper: Stepper<'s>, controller: Controller, h: f64) -> Self {
        stepper.estimate_errors();
        let watch = simulator.switches().map(|program| SwitchWatch::new(program, stepper.tile()));
        let switched = vec![false; stepper.alive().len()];
        let chatter = Chatter::new(switched.len());
        let features = simulator.features().map(FeatureWatch::new);
        Self { controller, stepper, h, watch, features, time: simulator.program.layout.time, switched, chatter }
    }

    /// The equations have just switched in all lanes.
    pub fn switch(&mut self) {
        self.switched.fill(true);
    }

    /// Whether the step size is too small to go on with.
    pub fn has_failed(&self) -> bool {
        self.h < self.controller.least()
    }

    /// Whether a sample has just passed a switch.
    pub fn has_switched(&self) -> bool {
        self.switched.contains(&true)
    }

    /// A lane that has been switching to and fro up to `time`, s, and would take too many steps up to the end of the
    /// run; the term of the equations that jumps, and since when, s.
    pub fn endless(&self, time: f64) -> Option<(usize, Expr, f64)> {
        let (lane, switch, since) =
            self.chatter.endless(self.stepper.alive(), time, self.controller.duration - time)?;
        self.watch.as_ref().map(|watch| (lane, watch.switch(switch).of, since))
    }

    /// Tries a step from `time` towards a goal. One that is not accepted is to be [rejected](Self::reject).
    pub fn attempt(&mut self, time: f64, goal: f64) -> Attempt {
        let left = goal - time;
        let (step, end) = match self.h {
            h if h >= left * (1.0 - 1e-9) => (left, goal),
            h if h > TUNING.halved_from * left => (0.5 * left, time + 0.5 * left),
            h => (h, time + h),
        };
        self.stepper.set_step_size(step);
        let before = self.stepper.save();
        // A rejected step leaves the time of its end.
        self.stepper.tile_mut().lane_mut(self.time).fill(time);
        if let Some(watch) = &mut self.watch {
            watch.begin(self.stepper.tile());
        }
        if let Some(features) = &mut self.features {
            features.begin(&self.stepper);
        }
        let converged = self.stepper.try_step(step, end);
        if let Some(watch) = &mut self.watch {
            watch.end(self.stepper.tile());
        }
        let passes = self.passes(&converged, step, end);
        let switched: Vec<Option<(usize, Crossing)>> =
            (0..converged.len()).map(|lane| self.crossing(lane, step)).collect();
        let crossings: Vec<Option<Crossing>> =
            switched.iter().map(|found| found.map(|(_, crossing)| crossing)).collect();
        let ratios = self.ratios(&converged, &crossings, &passes, step);
        let largest = ratios.iter().copied().fold(0.0, f64::max);
        let accepted = largest <= 1.0;
        let factor = self.controller.factor(largest);
        let next = step * if accepted { factor } else { factor.min(0.9) };
        let missed =
            crossings.iter().zip(&ratios).filter(|(_, ratio)| **ratio > 1.0).filter_map(|(crossing, _)| *crossing);
        let first = missed.map(|crossing| crossing.share).reduce(f64::min).filter(|_| step > self.controller.event());
        let crosses = crossings.iter().any(Option::is_some);
        self.h = match first {
            Some(share) => (step * share * (1.0 + TUNING.beyond_switch)).max(self.controller.event()).min(0.9 * step),
            // A step cut short at a goal is no reason against the longer one.
            None if accepted && step < self.h && !crosses => self.h.max(next),
            None => next,
        };
        if accepted {
            self.switched = crossings.iter().map(Option::is_some).collect();
            let watch = &self.watch;
            let of_velocity = |&index: &usize| watch.as_ref().is_some_and(|watch| watch.switch(index).of_velocity);
            let switches = switched.iter().map(|found| found.map(|(switch, _)| switch).filter(of_velocity));
            self.chatter.note(switches, end);
        }
        Attempt { step, end, ratios, accepted, before }
    }

    /// Restores the states before a step.
    pub fn reject(&mut self, attempt: &Attempt) {
        self.stepper.rewind(&attempt.before, attempt.step);
    }

    /// Lanes that pass over a feature of the forces. Like switches, features are located to a shortest step.
    fn passes(&mut self, converged: &[bool], step: f64, end: f64) -> Vec<bool> {
        let mut passes = vec![false; converged.len()];
        if let Some(features) = self.features.as_mut().filter(|_| step > self.controller.event()) {
            features.end(&self.stepper);
            for lane in (0..passes.len()).filter(|&lane| converged[lane] && self.stepper.alive()[lane]) {
                passes[lane] = features.change(&self.stepper, lane, step, end, TUNING.most_change);
            }
        }
        passes
    }

    fn crossing(&self, lane: usize, step: f64) -> Option<(usize, Crossing)> {
        let running = self.stepper.alive()[lane];
        self.watch.as_ref().filter(|_| running)?.crossing(lane, step)
    }

    fn ratios(&self, converged: &[bool], crossings: &[Option<Crossing>], passes: &[bool], step: f64) -> Vec<f64> {
        let ratio = |lane: usize| {
            let error = self.stepper.local_errors()[lane];
            let size = if self.switched[lane] || crossings[lane].is_some() { error.whole } else { error.size };
            let ratio = self.controller.error_ratio(size, step);
            // A switch right after another is no new event: equations may switch in every step, as with dry friction at
            // rest.
            let event = crossings[lane].filter(|_| !self.switched[lane]);
            let early = event.is_some_and(|crossing| !crossing.is_at_the_end()) && step > self.controller.event();
            match () {
                () if !self.stepper.alive()[lane] => 0.0,
                () if converged[lane] && !ratio.is_nan() && !early && !passes[lane] => ratio,
                () => f64::INFINITY,
            }
        };
        (0..converged.len()).map(ratio).collect()
    }
}
