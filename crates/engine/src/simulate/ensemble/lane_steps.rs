//! Samples that need shorter steps than the schedule has.
//!
//! The schedule is the controlling samples'. Another sample may meet a contact at another time, or move faster between
//! them. Where its local error in a step of the schedule is more than the step's share of the tolerance, or where its
//! equations switch, it takes steps of its own up to that step's end, and goes on with them until they are as long as
//! the schedule's.

use symdiff::Tile;

use super::tuning::TUNING;
use crate::compile::Tapes;
use crate::simulate::control::tuning::TUNING as CONTROL;
use crate::simulate::control::{Adaptive, Controller, SwitchWatch};
use crate::simulate::features::FeatureWatch;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{StepFailure, Stepper};

/// Keeps every lane of a tile within the tolerance.
#[derive(Debug)]
pub(super) struct LaneSteps<'s> {
    simulator: &'s Simulator,
    controller: Controller,
    watch: Option<SwitchWatch<'s>>,
    features: Option<FeatureWatch<'s>>,
    /// Lanes that go on alone.
    alone: Vec<Option<Box<Adaptive<'s>>>>,
    /// Sum of each lane's local errors over the tolerance.
    error_ratios: Vec<f64>,
}

impl<'s> LaneSteps<'s> {
    /// Steps of the lanes of a stepper at the beginning of a run.
    pub fn new(simulator: &'s Simulator, controller: Controller, stepper: &mut Stepper<'s>) -> Self {
        stepper.estimate_errors();
        let width = stepper.alive().len();
        Self {
            simulator,
            controller,
            watch: simulator.switches().map(|program| SwitchWatch::new(program, stepper.tile())),
            features: simulator.features().map(FeatureWatch::new),
            alone: (0..width).map(|_| None).collect(),
            error_ratios: vec![0.0; width],
        }
    }

    /// Sum of each lane's local errors over the tolerance.
    pub fn error_ratios(&self) -> &[f64] {
        &self.error_ratios
    }

    /// A step of the schedule, as [`Stepper::step`] does it. Where it is to end, the lanes' states are not those of the
    /// step's end.
    pub fn step(
        &mut self,
        stepper: &mut Stepper<'s>,
        h: f64,
        end: f64,
        asked: &mut StepInterruption<'_>,
    ) -> Vec<StepFailure> {
        let start = stepper.tile().lane(self.simulator.program.layout.time)[0];
        stepper.set_step_size(h);
        let before = stepper.save();
        if let Some(watch) = &mut self.watch {
            watch.begin(stepper.tile());
        }
        if let Some(features) = &mut self.features {
            features.begin(stepper);
        }
        let converged = stepper.try_step(h, end);
        if let Some(watch) = &mut self.watch {
            watch.end(stepper.tile());
        }
        if let Some(features) = &mut self.features {
            features.end(stepper);
        }
        let mut failures = Vec::new();
        for lane in (0..converged.len()).filter(|&lane| stepper.alive()[lane]).collect::<Vec<_>>() {
            let crossing = self.watch.as_ref().filter(|_| converged[lane]).and_then(|watch| watch.crossing(lane, h));
            let crossing = crossing.map(|(_, crossing)| crossing);
            let error = stepper.local_errors()[lane];
            let size = if crossing.is_some() { error.whole } else { error.size };
            let ratio = self.controller.error_ratio(size, h);
            let features = self.features.as_mut().filter(|_| converged[lane] && h > self.controller.event());
            let passes = features.is_some_and(|features| features.change(stepper, lane, h, end, CONTROL.most_change));
            let within =
                converged[lane] && !passes && ratio <= 1.0 && crossing.is_none_or(|crossing| crossing.is_at_the_end());
            let attached = self.alone[lane].as_ref().is_none_or(|alone| alone.h >= h && !alone.has_switched());
            if within && attached {
                self.error_ratios[lane] += ratio * h / self.controller.duration;
                // The time after a switch is not left to the schedule's steps.
                self.alone[lane] = crossing.is_some().then(|| self.detached(stepper, lane, h, None));
                continue;
            }
            let mut alone = match self.alone[lane].take() {
                Some(alone) => alone,
                None => self.detached(stepper, lane, h, Some(&before)),
            };
            match self.advance(&mut alone, stepper, (start, end), asked) {
                Ok(ratio) => {
                    self.error_ratios[lane] += ratio;
                    alone.stepper.set_step_size(h);
                    stepper.set_lane(lane, &alone.stepper);
                    self.alone[lane] = Some(alone);
                }
                Err(()) if converged[lane] => self.error_ratios[lane] += ratio.max(1.0),
                Err(()) => {
                    let equation = alone.stepper.worst_equation(0);
                    failures.push(StepFailure { lane, time: end, equation });
                    stepper.retire(lane..lane + 1);
                }
            }
        }
        failures
    }

    /// Lanes that go on alone do so from the stepper's present states, as where their equations switch.
    pub fn begin_anew(&mut self, stepper: &Stepper<'s>) {
        for lane in 0..self.alone.len() {
            if let Some(before) = self.alone[lane].take() {
                let mut alone = self.detached(stepper, lane, stepper.step_size(), None);
                alone.h = before.h;
                self.alone[lane] = Some(alone);
            }
        }
    }

    /// A lane alone, in its present state or in that of states saved before.
    fn detached(&self, stepper: &Stepper<'s>, lane: usize, h: f64, saved: Option<&[f64]>) -> Box<Adaptive<'s>> {
        let program = &self.simulator.program;
        let (width, mut tile) = (stepper.alive().len(), Tile::new(1, program.registers(), program.constants()));
        for (register, value) in stepper.lane(lane).into_iter().enumerate() {
            tile.lane_mut(register)[0] = value;
        }
        let mut alone = Stepper::new(program, &tile);
        let state = match saved {
            Some(saved) => saved.iter().skip(lane).step_by(width).copied().collect(),
            None => alone.save(),
        };
        alone.rewind(&state, h);
        let mut alone = Adaptive::new(self.simulator, alone, self.controller, h);
        if saved.is_none() {
            alone.switch();
        }
        Box::new(alone)
    }

    /// Steps alone from `start` to `end`; the sum of local errors over the tolerance.
    ///
    /// # Errors
    /// Where no step is short enough, and at an interruption.
    fn advance(
        &mut self,
        alone: &mut Adaptive<'s>,
        stepper: &mut Stepper<'s>,
        (start, end): (f64, f64),
        asked: &mut StepInterruption<'_>,
    ) -> Result<f64, ()> {
        let counted = alone.stepper.counters();
        alone.stepper.refine(stepper.refines());
        let (mut time, mut sum, mut reached) = (start, 0.0, false);
        for _ in 0..TUNING.most_lane_steps {
            if asked.ends() {
                break;
            }
            let attempt = alone.attempt(time, end);
            if alone.has_failed() {
                break;
            }
            if attempt.accepted {
                sum += attempt.ratios[0] * attempt.step / self.controller.duration;
                time = attempt.end;
            } else {
                alone.reject(&attempt);
            }
            if time == end {
                reached = true;
                break;
            }
        }
        stepper.count_since(alone.stepper.counters(), counted);
        if reached { Ok(sum) } else { Err(()) }
    }
}
