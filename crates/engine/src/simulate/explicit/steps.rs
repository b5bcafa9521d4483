//! The steps that a tolerance asks for: all controlling samples in step, the worst decides; and obstacles to the
//! method.

use super::controlling::Tiles;
use super::runge_kutta::next_length;
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::control::tuning::TUNING as CONTROL;
use crate::simulate::control::{Integration, Schedule};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;
use crate::simulate::time_functions::ResolvingSteps;

/// Why the explicit method is not for a motion.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExplicitObstacle {
    /// Stability limits the steps, not accuracy.
    #[error("the motion is stiff from t = {time:.3} s on: stability limits its steps to {step:.1e} s")]
    Stiff {
        /// s
        time: f64,
        /// s
        step: f64,
    },
    /// It takes more steps than it may.
    #[error("it takes more than {steps} steps")]
    TooManySteps {
        /// Most steps.
        steps: usize,
    },
    /// A force changes in space within a step.
    #[error("a step from t = {time:.3} s passes over a change of a force in space, at different times in the samples")]
    PassesOver {
        /// s
        time: f64,
    },
    /// No step is small enough.
    #[error("no step is small enough at t = {time:.3} s: the motion is not smooth there, or the position is singular")]
    StepTooSmall {
        /// s
        time: f64,
    },
}

/// The schedule of at most `most` steps at which every controlling sample keeps each step's error below `tolerance`.
/// Rows stand where they are; steps pass over them.
///
/// # Errors
/// If a controlling sample cannot be assembled, and at an interruption; inside, the obstacle to the method.
pub fn explicit_schedule(
    simulator: &Simulator,
    samples: &[Sample],
    duration: f64,
    output_step: f64,
    tolerance: f64,
    most: usize,
    interruption: Interruption<'_>,
) -> Result<Result<Schedule, ExplicitObstacle>, SimulationError> {
    let mut tiles = Tiles::start(simulator, samples, duration)?;
    let too_many = Ok(Err(ExplicitObstacle::TooManySteps { steps: most }));
    let functions = simulator.time_functions(duration);
    let functions = functions.map(|functions| ResolvingSteps::new(functions, &simulator.system, most)).transpose();
    let Ok(mut functions) = functions else { return too_many };
    let instants = Instants::of(simulator);
    let (mut ends, mut time, mut h) = (Vec::new(), 0.0, CONTROL.first_step * output_step);
    let (mut stiff, mut others) = (0, 0);
    // The step that a switch cut short.
    let mut uncut: Option<f64> = None;
    let mut switches = Vec::new();
    while time < duration {
        if interruption.is_asked() {
            return Err(SimulationError::Interrupted);
        }
        if ends.len() == most {
            return too_many;
        }
        if h < TUNING.smallest_step * duration {
            return Ok(Err(ExplicitObstacle::StepTooSmall { time }));
        }
        let resolved = match &mut functions {
            Some(functions) => functions.longest(time, h.min(duration - time), &simulator.system),
            None => Ok(h),
        };
        let Ok(step) = resolved else { return too_many };
        let step = match instants.between(time, time + step) {
            Some(instant) => Schedule::at_row(instant, duration, output_step) - time,
            None => step,
        };
        let end = if time + step * (1.0 + 1e-9) >= duration { duration } else { time + step };
        let worst = tiles.attempt(end, tolerance);
        let located = TUNING.located * duration;
        let early = tiles.crossing(step).filter(|&share| share < 1.0 - TUNING.at_the_end && step > located);
        if let Some(share) = early {
            tiles.reject();
            uncut = uncut.or(Some(h));
            h = (step * share * (1.0 + 0.1 * TUNING.at_the_end)).max(located).min(0.999 * step);
            continue;
        }
        if worst.ratio > 1.0 {
            tiles.reject();
            h = next_length(step, worst.ratio);
            continue;
        }
        if tiles.pass_over(end) {
            return Ok(Err(ExplicitObstacle::PassesOver { time }));
        }
        if worst.stiffness > TUNING.largest_stable {
            (stiff, others) = (stiff + 1, 0);
        } else {
            others += 1;
            stiff = if others >= TUNING.others_between { 0 } else { stiff };
        }
        if stiff == TUNING.stiff_steps {
            return Ok(Err(ExplicitObstacle::Stiff { time, step }));
        }
        tiles.accept(end);
        ends.push(end);
        time = end;
        if let Some(before) = uncut.take() {
            switches.push(ends.len() - 1);
            h = before;
            continue;
        }
        // A step cut short at the end, or by a function of the time, is no reason against the longer one.
        h = if step < h { h } else { next_length(step, worst.ratio) };
    }
    Ok(Ok(Schedule::passing(duration, output_step, ends, switches).taken(Integration::Explicit)))
}
