//! A step schedule from a tolerance: pilot samples, stepped together, decide the steps that all samples take.

use super::hht::Stepper;
use super::simulator::{SimulationError, Simulator};
use super::steps::{Controller, Schedule};

/// Share of the output step with which the pilots begin.
const FIRST: f64 = 1e-2;

/// Steps longer than this share of what is left up to a row are cut to halve it, so that no sliver remains.
const HALVE: f64 = 0.55;

/// A schedule, and what ended it before the duration did.
#[derive(Clone, Debug, PartialEq)]
pub struct Piloted {
    /// Up to the last row that was reached.
    pub schedule: Schedule,
    /// Why no further.
    pub failure: Option<SimulationError>,
}

/// The schedule at which every pilot keeps its local position error below `tolerance`: rows at whole multiples of
/// `output_step`, a step taken again where the worst pilot's error is too large or a pilot does not converge.
///
/// Where no step is small enough, the schedule ends.
///
/// # Errors
/// Where a pilot cannot be assembled.
pub fn schedule(
    simulator: &Simulator,
    pilots: &[Vec<f64>],
    duration: f64,
    output_step: f64,
    tolerance: f64,
) -> Result<Piloted, SimulationError> {
    let controller = Controller { tolerance };
    let width = symdiff::WIDTHS.into_iter().find(|&width| width >= pilots.len()).unwrap_or(pilots.len());
    let mut h = FIRST * output_step;
    let start = simulator.assemble(width, h, |lane| pilots[lane.min(pilots.len() - 1)].clone())?;
    let mut stepper = Stepper::new(&simulator.program, &start);
    let rows = Schedule::rows_of(duration, output_step);
    let mut ends = Vec::with_capacity(rows - 1);
    for row in 1..rows {
        let (mut time, goal) = ((row - 1) as f64 * output_step, row as f64 * output_step);
        let mut list = Vec::new();
        while time < goal {
            let left = goal - time;
            let (step, end) = match h {
                h if h >= left * (1.0 - 1e-9) => (left, goal),
                h if h > HALVE * left => (0.5 * left, time + 0.5 * left),
                h => (h, time + h),
            };
            stepper.set_step_size(step);
            let before = stepper.save();
            let converged = stepper.try_step(step, end).iter().all(|&lane| lane);
            let errors = stepper.local_error(&before, step);
            let error = if converged { errors.into_iter().fold(0.0, f64::max) } else { f64::INFINITY };
            let factor = controller.factor(error);
            if error <= tolerance {
                time = end;
                list.push(end);
                // A step cut short to meet a row says nothing against the longer one.
                h = if step < h { h.max(step * factor) } else { step * factor };
            } else {
                stepper.rewind(&before, step);
                h = step * factor.min(0.9);
                if h < Controller::SMALLEST * duration {
                    let failure = Some(SimulationError::StepTooSmall { step: h, time });
                    return Ok(Piloted { schedule: Schedule::listed(output_step, ends), failure });
                }
            }
        }
        ends.push(list);
    }
    Ok(Piloted { schedule: Schedule::listed(output_step, ends), failure: None })
}
