//! Model exchange: the unit's equations are integrated by Dormand and Prince's method of fifth order with fixed steps,
//! so that all samples share their times. Steps end at events: at times that the unit announces, and at sign changes of
//! an indicator, which are located by bisection of the step.
//!
//! Source: Dormand, Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980) 19-26.

use super::steps::Steps;
use super::tuning::TUNING;
use crate::native::{Discrete, Fault, Instance};

/// Rows of the method, without its seventh stage, which only an error estimate would need.
const STAGES: [&[f64]; 6] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
];
const NODES: [f64; 6] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];
const WEIGHTS: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// A motion of an instance, with its memory.
struct Motion<'i> {
    instance: &'i mut dyn Instance,
    time: f64,
    /// Time of the last row, s.
    end: f64,
    states: Vec<f64>,
    /// States of a stage, or of the end of a step.
    trial: Vec<f64>,
    slopes: [Vec<f64>; 6],
    indicators: Vec<f64>,
    others: Vec<f64>,
    /// Time of the next event that the unit knows.
    next: Option<f64>,
    events: usize,
}

/// Integrates an initialised instance from row to row by steps of at most `step`, s, calling `row` at each.
///
/// # Errors
/// If a function fails, or events do not end.
pub fn run(
    instance: &mut dyn Instance,
    states: usize,
    times: &[f64],
    step: f64,
    row: &mut dyn FnMut(&mut dyn Instance) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let zeros = || vec![0.0; states];
    let mut motion = Motion {
        instance,
        time: times[0],
        end: times[times.len() - 1],
        states: zeros(),
        trial: zeros(),
        slopes: std::array::from_fn(|_| zeros()),
        indicators: Vec::new(),
        others: Vec::new(),
        next: None,
        events: 0,
    };
    motion.happen()?;
    row(motion.instance)?;
    for pair in times.windows(2) {
        let steps = Steps::between(pair[0], pair[1], step);
        for index in 1..=steps.count {
            motion.go_to(steps.time(index), steps.size())?;
        }
        row(motion.instance)?;
    }
    Ok(())
}

impl Motion<'_> {
    /// Moves on to a time, s, by one step, or by several if events are between; `whole` is the step's full length.
    fn go_to(&mut self, end: f64, whole: f64) -> Result<(), Fault> {
        while end - self.time > TUNING.no_step * whole {
            let is_event = self.next.is_some_and(|next| next <= end);
            let target = self.next.map_or(end, |next| next.min(end));
            if target - self.time > 0.0 {
                self.step(target - self.time)?;
            }
            if self.changes(target)? {
                let (from, mut before, mut after) = (self.time, 0.0, target - self.time);
                for _ in 0..TUNING.halvings_of_step {
                    let middle = 0.5 * (before + after);
                    self.step(middle)?;
                    *(if self.changes(from + middle)? { &mut after } else { &mut before }) = middle;
                }
                self.step(after)?;
                self.arrive(from + after)?;
                self.event()?;
                continue;
            }
            self.arrive(target)?;
            let done = self.instance.completed()?;
            if self.ends(done)? {
                return Ok(());
            }
            if done.again || is_event {
                self.event()?;
            }
        }
        Ok(())
    }

    /// Computes the states after a step of a length, s, as `trial`; the motion does not advance.
    fn step(&mut self, length: f64) -> Result<(), Fault> {
        for stage in 0..STAGES.len() {
            self.combine(STAGES[stage], length);
            self.instance.set_time(self.time + NODES[stage] * length)?;
            self.set_trial()?;
            self.instance.derivatives(&mut self.slopes[stage])?;
        }
        self.combine(&WEIGHTS, length);
        Ok(())
    }

    /// Sets `trial` to the states plus a combination of slopes.
    fn combine(&mut self, weights: &[f64], length: f64) {
        for (index, trial) in self.trial.iter_mut().enumerate() {
            let slope: f64 = weights.iter().zip(&self.slopes).map(|(weight, slope)| weight * slope[index]).sum();
            *trial = self.states[index] + length * slope;
        }
    }

    fn set_trial(&mut self) -> Result<(), Fault> {
        // A unit without states need not have the function.
        if self.trial.is_empty() { Ok(()) } else { self.instance.set_states(&self.trial) }
    }

    /// Whether an indicator has another sign at a time with the states of `trial`.
    fn changes(&mut self, time: f64) -> Result<bool, Fault> {
        if self.indicators.is_empty() {
            return Ok(false);
        }
        self.instance.set_time(time)?;
        self.set_trial()?;
        self.instance.indicators(&mut self.others)?;
        Ok(self.indicators.iter().zip(&self.others).any(|(a, b)| (*a > 0.0) != (*b > 0.0)))
    }

    /// Moves to the states of `trial`.
    fn arrive(&mut self, time: f64) -> Result<(), Fault> {
        self.time = time;
        self.states.copy_from_slice(&self.trial);
        self.instance.set_time(time)?;
        self.set_trial()
    }

    /// Whether the unit ends its motion with the last row.
    ///
    /// # Errors
    /// If it does so before.
    fn ends(&self, found: Discrete) -> Result<bool, Fault> {
        match found.terminates && self.end - self.time > TUNING.no_step * self.end {
            true => Err(Fault::Terminated(self.time)),
            false => Ok(found.terminates),
        }
    }

    /// Handles an event now.
    fn event(&mut self) -> Result<(), Fault> {
        self.events += 1;
        if self.events > TUNING.most_events {
            return Err(Fault::Events { count: TUNING.most_events, time: self.time });
        }
        self.instance.enter_events()?;
        self.happen()
    }

    /// Updates discrete states until they stay, from the mode of events to that of continuous time.
    fn happen(&mut self) -> Result<(), Fault> {
        let mut repetitions = 0;
        loop {
            let found = self.instance.update_discrete()?;
            // The unit stays in the mode of events: only values are read after this.
            if self.ends(found)? {
                return Ok(());
            }
            self.next = found.next;
            if !found.again {
                break;
            }
            repetitions += 1;
            if repetitions > TUNING.most_repetitions {
                return Err(Fault::Events { count: TUNING.most_repetitions, time: self.time });
            }
        }
        self.instance.enter_continuous()?;
        if !self.states.is_empty() {
            self.instance.states(&mut self.states)?;
            self.trial.copy_from_slice(&self.states);
        }
        self.instance.indicators(&mut self.indicators)
    }
}
