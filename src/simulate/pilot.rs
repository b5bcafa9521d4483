//! A step schedule from a tolerance: pilot samples, stepped together, decide the steps that all samples take.

use super::hht::{LocalError, Stepper};
use super::simulator::{SimulationError, Simulator};
use super::steps::{Controller, Schedule};

/// Share of the output step with which the pilots begin.
const FIRST: f64 = 1e-2;

/// Where a run ends, its constraints are looked at this share of an output step later: an opening needs time to show.
const LOOK_AHEAD: f64 = 0.5;

/// Steps longer than this share of what is left up to a row are cut to halve it, so that no sliver remains.
const HALVE: f64 = 0.55;

/// Steps that a schedule has at most: where it needs more, something goes on that no step resolves.
const MOST_STEPS: usize = 2_000_000;

/// A schedule, and what ended it before the duration did.
#[derive(Clone, Debug, PartialEq)]
pub struct Piloted {
    /// Up to the last row that a pilot reached.
    pub schedule: Schedule,
    /// Rows that all have reached.
    pub whole: usize,
    /// Pilots that were left behind.
    pub left_behind: Vec<usize>,
    /// Why not all reached more.
    pub failure: Option<SimulationError>,
}

/// The schedule at which every pilot keeps its local position errors within their shares of `tolerance`: rows at whole
/// multiples of `output_step`, a step taken again where the worst pilot's error is too large or a pilot does not converge.
///
/// A pilot for which no step is small enough is left behind, and the others go on. Where there are too many steps, the schedule
/// ends.
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
    let controller = Controller { tolerance, duration };
    let width = symdiff::WIDTHS.into_iter().find(|&width| width >= pilots.len()).unwrap_or(pilots.len());
    let mut h = FIRST * output_step;
    let start = simulator.assemble(width, h, |lane| pilots[lane.min(pilots.len() - 1)].clone())?;
    let mut stepper = Stepper::new(&simulator.program, &start);
    stepper.estimate_errors();
    let rows = Schedule::rows_of(duration, output_step);
    let mut ends = Vec::with_capacity(rows - 1);
    let mut count = 0;
    let (mut whole, mut left_behind, mut failure) = (rows, Vec::new(), None);
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
            let strains = strains(&mut stepper, step, end, controller);
            let strain = strains.iter().copied().fold(0.0, f64::max);
            let (factor, accepted) = (controller.factor(strain), strain <= 1.0);
            let next = step * if accepted { factor } else { factor.min(0.9) };
            // A step cut short to meet a row says nothing against the longer one.
            h = if accepted && step < h { h.max(next) } else { next };
            if h < Controller::SMALLEST * duration || count == MOST_STEPS {
                // Of them, one is the worst.
                let resisting: Vec<usize> = (0..width).filter(|&lane| strains[lane] >= strain.min(1.0)).collect();
                let lane = *resisting.iter().find(|&&lane| strains[lane] == strain).unwrap_or(&resisting[0]);
                let cause = cause(simulator, &mut stepper, lane, strain);
                stepper.rewind(&before, step);
                let parameters = simulator.with_names(&pilots[lane.min(pilots.len() - 1)]);
                let later = goal.max(time + LOOK_AHEAD * output_step);
                let error = match simulator.stays_open(&stepper.lane(lane), later) {
                    Some((constraint, amount)) => {
                        let constraint = simulator.system.constraints[constraint].name.clone();
                        SimulationError::Locked { time, constraint, amount, parameters }
                    }
                    None if count == MOST_STEPS => SimulationError::TooManySteps { steps: count, step, time, cause },
                    None => SimulationError::StepTooSmall { step: h, time, cause, parameters },
                };
                whole = whole.min(row);
                failure.get_or_insert(error);
                resisting.iter().for_each(|&lane| stepper.retire(lane..lane + 1));
                left_behind.extend(resisting.into_iter().filter(|&lane| lane < pilots.len()));
                if !stepper.alive().contains(&true) || count == MOST_STEPS {
                    let schedule = Schedule::listed(output_step, ends);
                    return Ok(Piloted { schedule, whole, left_behind, failure });
                }
                h = FIRST * output_step;
            } else if accepted {
                time = end;
                list.push(end);
                count += 1;
            } else {
                stepper.rewind(&before, step);
            }
        }
        ends.push(list);
    }
    Ok(Piloted { schedule: Schedule::listed(output_step, ends), whole, left_behind, failure })
}

/// The strain of every lane that runs in a step: infinite where it does not converge.
fn strains(stepper: &mut Stepper, step: f64, end: f64, controller: Controller) -> Vec<f64> {
    let converged = stepper.try_step(step, end);
    let lanes = stepper.alive().iter().zip(converged).zip(stepper.local_errors());
    let strain = |((running, converged), error): ((&bool, bool), &LocalError)| match controller.strain(error.size, step)
    {
        _ if !running => 0.0,
        strain if converged && !strain.is_nan() => strain,
        _ => f64::INFINITY,
    };
    lanes.map(strain).collect()
}

/// What keeps a pilot from its tolerance: an equation that does not converge, or the acceleration that changes most.
fn cause(simulator: &Simulator, stepper: &mut Stepper, lane: usize, strain: f64) -> String {
    if strain.is_finite() {
        let LocalError { coordinate, change, .. } = stepper.local_errors()[lane];
        let name = &simulator.system.coordinates[coordinate].name;
        return format!("the acceleration of `{name}` changes by {change:.3e} within one of them");
    }
    let equation = simulator.equation_name(stepper.worst_equation(lane));
    format!("Newton's iteration does not converge, and the largest residual is that of `{equation}`")
}
