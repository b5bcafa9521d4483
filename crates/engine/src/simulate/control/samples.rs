//! A step schedule from a tolerance: controlling samples, stepped together, decide the steps that all samples take.

use symdiff::{Expr, WIDTHS};

use super::adaptive::{Adaptive, Attempt};
use super::controller::Controller;
use super::schedule::Schedule;
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::diagnostics::{place_of, written};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{LocalError, Stepper};
use crate::simulate::time_functions::ResolvingSteps;

/// A schedule from a tolerance, and the reason if it ends before the duration.
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceSchedule {
    /// Schedule up to the last row that a controlling sample reached.
    pub schedule: Schedule,
    /// Rows that all controlling samples have reached.
    pub complete_rows: usize,
    /// Controlling samples that were dropped on the way.
    pub dropped: Vec<usize>,
    /// Why not all samples reached more rows.
    pub failure: Option<SimulationError>,
}

/// The schedule at which every controlling sample keeps its local position errors within their shares of `tolerance`.
/// Rows are whole multiples of `output_step`, and the end; a step is repeated with a smaller size where the largest
/// error is too large or a sample does not converge.
///
/// A sample for which no step is small enough is dropped, and the others continue. If there are too many steps, the
/// schedule ends; so does it at an interruption.
///
/// # Errors
/// Where a controlling sample cannot be assembled, and where functions of the time take far too many steps.
pub fn schedule_for_tolerance(
    simulator: &Simulator,
    samples: &[Sample],
    duration: f64,
    output_step: f64,
    tolerance: f64,
    interruption: Interruption<'_>,
) -> Result<ToleranceSchedule, SimulationError> {
    let controller = Controller { tolerance, duration };
    let mut control = Control::start(simulator, samples, controller, output_step)?;
    let rows = Schedule::rows_of(duration, output_step);
    let mut ends = Vec::with_capacity(rows - 1);
    let (mut complete_rows, mut failure) = (rows, None);
    'rows: for row in 1..rows {
        let (begin, goal) = ((row - 1) as f64 * output_step, Schedule::time_of(duration, output_step, row));
        let mut time = begin;
        let mut list = Vec::new();
        let at_row = control.steps.clone();
        while time < goal {
            if interruption.is_asked_in(control.tries) {
                complete_rows = complete_rows.min(row);
                break 'rows;
            }
            match control.step(time, goal) {
                Outcome::Accepted(end) => {
                    time = end;
                    list.push(end);
                }
                Outcome::Rejected => {}
                Outcome::Ended(error) => {
                    complete_rows = complete_rows.min(row);
                    failure.get_or_insert(error);
                    break 'rows;
                }
                Outcome::Dropped(error) => {
                    complete_rows = complete_rows.min(row);
                    failure.get_or_insert(error);
                    // The ever smaller steps towards its end would spoil the others' accelerations.
                    control.restore(at_row.clone());
                    (time, list) = (begin, Vec::new());
                    if control.is_over() {
                        break 'rows;
                    }
                }
            }
        }
        ends.push(list);
    }
    let schedule = Schedule::listed(output_step, ends);
    Ok(ToleranceSchedule { schedule, complete_rows, dropped: control.dropped, failure })
}

/// The controlling samples in step.
struct Control<'s> {
    simulator: &'s Simulator,
    samples: &'s [Sample],
    output_step: f64,
    steps: Adaptive<'s>,
    functions: Option<ResolvingSteps>,
    sampling: Option<Sampling<'s>>,
    /// Accepted steps, and those tried.
    count: usize,
    tries: usize,
    dropped: Vec<usize>,
}

/// Outcome of a step.
enum Outcome {
    /// The step stands; it ends at this time.
    Accepted(f64),
    /// The step is to be repeated with a smaller size.
    Rejected,
    /// No sample goes on.
    Ended(SimulationError),
    /// No step is small enough for some samples, which no longer run.
    Dropped(SimulationError),
}

impl<'s> Control<'s> {
    fn start(
        simulator: &'s Simulator,
        samples: &'s [Sample],
        controller: Controller,
        output_step: f64,
    ) -> Result<Self, SimulationError> {
        let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
        let h = TUNING.first_step * output_step;
        let start = simulator.assemble(width, h, |lane| samples[lane.min(samples.len() - 1)].clone())?;
        let steps = Adaptive::new(simulator, Stepper::new(&simulator.program, &start), controller, h);
        let functions = simulator.time_functions(controller.duration);
        let functions = functions
            .map(|functions| ResolvingSteps::new(functions, &simulator.system, TUNING.most_steps))
            .transpose()?;
        let sampling = Sampling::new(simulator, &start);
        Ok(Self {
            simulator,
            samples,
            output_step,
            steps,
            functions,
            sampling,
            count: 0,
            tries: 0,
            dropped: Vec::new(),
        })
    }

    /// Goes back to an earlier state, without the samples that were dropped since.
    fn restore(&mut self, mut earlier: Adaptive<'s>) {
        let running = self.steps.stepper.alive().to_vec();
        for lane in (0..running.len()).filter(|&lane| !running[lane]) {
            earlier.stepper.retire(lane..lane + 1);
        }
        self.steps = earlier;
    }

    /// Whether no sample runs any more, or the schedule has as many steps as it may have.
    fn is_over(&self) -> bool {
        !self.steps.stepper.alive().contains(&true) || self.count == TUNING.most_steps
    }

    /// Tries a step from `time` towards the row at `goal`.
    fn step(&mut self, time: f64, goal: f64) -> Outcome {
        self.tries += 1;
        let goal = Instants::of(self.simulator).between(time, goal).unwrap_or(goal);
        let step = self.steps.h.min(goal - time);
        let longest = self.functions.as_mut().map(|functions| functions.longest(time, step, &self.simulator.system));
        let goal_of_step = match longest {
            Some(Err(error)) => return Outcome::Ended(error),
            Some(Ok(shorter)) if shorter < step && time + shorter > time => time + shorter,
            _ => goal,
        };
        let attempt = self.steps.attempt(time, goal_of_step);
        if self.steps.has_failed() || self.count == TUNING.most_steps {
            Outcome::Dropped(self.drop_failing(&attempt, time, goal))
        } else if attempt.accepted {
            self.count += 1;
            if let Some((lane, term, since)) = self.steps.endless(attempt.end) {
                return Outcome::Ended(self.chattering(lane, term, since, attempt.step));
            }
            if let Some(sampling) = &mut self.sampling {
                sampling.end(&mut self.steps.stepper, attempt.end);
            }
            Outcome::Accepted(attempt.end)
        } else {
            self.steps.reject(&attempt);
            Outcome::Rejected
        }
    }

    /// Drops the samples whose error ratios are too large, restores the others' state and says why.
    fn drop_failing(&mut self, attempt: &Attempt, time: f64, goal: f64) -> SimulationError {
        let Attempt { ratios, step, .. } = attempt;
        let largest = ratios.iter().copied().fold(0.0, f64::max);
        let failing: Vec<usize> = (0..ratios.len()).filter(|&lane| ratios[lane] >= largest.min(1.0)).collect();
        // One of them has the largest ratio.
        let lane = *failing.iter().find(|&&lane| ratios[lane] == largest).unwrap_or(&failing[0]);
        let cause = self.cause(lane, largest);
        self.steps.reject(attempt);
        let parameters = self.simulator.with_names(&self.samples[lane.min(self.samples.len() - 1)]);
        let later = goal.max(time + TUNING.look_ahead * self.output_step);
        let error = match self.simulator.open_constraint(&self.steps.stepper.lane(lane), later) {
            Some(open) => self.simulator.locked(open, time, parameters),
            None if self.count == TUNING.most_steps => {
                SimulationError::TooManySteps { steps: self.count, step: *step, time, cause }
            }
            None => SimulationError::StepTooSmall { step: self.steps.h, time, cause, parameters },
        };
        failing.iter().for_each(|&lane| self.steps.stepper.retire(lane..lane + 1));
        // Lanes beyond the samples repeat the last one.
        self.dropped.extend(failing.into_iter().filter(|&lane| lane < self.samples.len()));
        self.steps.h = TUNING.first_step * self.output_step;
        error
    }

    /// Why no sample goes on: the term of the equations that switches to and fro in a lane is that of all others.
    fn chattering(&self, lane: usize, term: Expr, time: f64, step: f64) -> SimulationError {
        let system = &self.simulator.system;
        let LocalError { coordinate, change, .. } = self.steps.stepper.local_errors()[lane];
        let cause = format!(
            "{} jumps to and fro and changes the acceleration of `{}` by {change:.3e}, as `sign` of a velocity does at \
             rest; a smooth law holds it: `tanh(v/v0)` in place of `sign(v)`, with a small speed v0, or the effect \
             `joint_friction`",
            place_of(system, term, &written(&system.graph, term)),
            system[coordinate].name,
        );
        SimulationError::TooManySteps { steps: TUNING.most_chattering, step, time, cause }
    }

    /// Why a lane misses its tolerance: an equation that does not converge, or the acceleration that changes most.
    fn cause(&mut self, lane: usize, error_ratio: f64) -> String {
        let stepper = &mut self.steps.stepper;
        if error_ratio.is_finite() {
            let LocalError { coordinate, change, .. } = stepper.local_errors()[lane];
            let name = &self.simulator.system[coordinate].name;
            return format!("the acceleration of `{name}` changes by {change:.3e} within one of them");
        }
        let equation = self.simulator.equation_name(stepper.worst_equation(lane));
        format!("Newton's iteration does not converge, and the largest residual is that of `{equation}`")
    }
}
