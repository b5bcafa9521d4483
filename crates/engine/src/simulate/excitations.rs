//! Excitations of fast modes after the start: a jump of a force, a stop, a contact. Steps that are long for a mode damp
//! its vibration, and halved steps do too.
//!
//! In the nominal motion, f = φᵀM(ẅ + ω²(q − q₀)) is the force on a mode φ: for as long as it is smooth, the mode
//! follows it. Where f jumps within a step by more than the steps before would let expect, the mode starts to vibrate
//! with the amplitude of the jump over ω². Steps that are short for the mode (of a function of the time that is
//! followed closely) make it vibrate themselves; its amplitude at their end is its excitation.

use std::collections::VecDeque;

use symdiff::math;

use super::control::Schedule;
use super::simulator::Simulator;
use super::step::Stepper;
use super::tuning::TUNING;
use crate::numerics::Sample;

/// A mode that is watched.
#[derive(Clone, Debug)]
pub struct WatchedMode {
    /// Mφ.
    pub weighted: Vec<f64>,
    /// ω, rad/s.
    pub frequency: f64,
}

/// A vibration that begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excitation {
    /// s
    pub time: f64,
    /// Amplitude of the mode (of φᵀMφ = 1).
    pub amplitude: f64,
}

/// Excitations of modes after the start of the nominal motion on a schedule; steps resolve a mode whose frequency is at
/// most `resolved` over their length. Ends where a step fails.
pub fn excitations(
    simulator: &Simulator,
    schedule: &Schedule,
    modes: &[WatchedMode],
    resolved: f64,
) -> Vec<Vec<Excitation>> {
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let Ok(start) = simulator.assemble(1, schedule.first_step(), |_| nominal.clone()) else {
        return vec![Vec::new(); modes.len()];
    };
    let layout = &simulator.program.layout;
    let mut stepper = Stepper::new(&simulator.program, &start);
    let at_start: Vec<f64> = layout.q.clone().map(|register| start.lane(register)[0]).collect();
    let mut watches: Vec<Watch> = modes.iter().map(|_| Watch::default()).collect();
    for (h, end) in (0..schedule.rows).flat_map(|row| schedule.steps_to(row)) {
        if !stepper.step(h, end).is_empty() {
            break;
        }
        for (watch, mode) in watches.iter_mut().zip(modes) {
            let along = |registers: std::ops::Range<usize>, origin: Option<&Vec<f64>>| -> f64 {
                let value = |(index, register): (usize, usize)| {
                    stepper.tile().lane(register)[0] - origin.map_or(0.0, |origin| origin[index])
                };
                let values = registers.enumerate().map(value);
                mode.weighted.iter().zip(values).map(|(weight, value)| weight * value).sum()
            };
            let state = State {
                position: along(layout.q.clone(), Some(&at_start)),
                velocity: along(layout.v.clone(), None),
                acceleration: along(layout.w.clone(), None),
            };
            watch.look(state, end, mode.frequency, mode.frequency * h <= resolved);
        }
    }
    watches.into_iter().map(|watch| watch.found).collect()
}

/// A mode's part in a motion.
#[derive(Clone, Copy, Debug)]
struct State {
    position: f64,
    velocity: f64,
    acceleration: f64,
}

/// State of a mode up to a step.
#[derive(Debug, Default)]
struct Watch {
    /// The last times, and f there.
    forces: VecDeque<(f64, f64)>,
    /// Distance of f from its extrapolation in the last steps.
    differences: VecDeque<f64>,
    /// Since steps resolve the mode: its velocity before, and its state.
    followed: Option<(f64, State)>,
    velocity: f64,
    found: Vec<Excitation>,
}

impl Watch {
    fn look(&mut self, state: State, time: f64, frequency: f64, is_resolved: bool) {
        let square = frequency * frequency;
        if is_resolved {
            let before = self.followed.map_or(self.velocity, |(before, _)| before);
            self.followed = Some((before, state));
        } else if let Some((before, last)) = self.followed.take() {
            let amplitude = math::hypot(last.acceleration / square, (last.velocity - before) / frequency);
            self.found.push(Excitation { time, amplitude });
            self.forces.clear();
        }
        self.velocity = state.velocity;
        if is_resolved {
            return;
        }
        let force = state.acceleration + square * state.position;
        if self.forces.len() == TUNING.jump_points {
            let difference = force - self.extrapolated(time);
            let expected = self.differences.iter().fold(0.0_f64, |most, difference| most.max(difference.abs()));
            if self.differences.len() == TUNING.jump_steps && difference.abs() > TUNING.jump_factor * expected {
                self.found.push(Excitation { time, amplitude: difference.abs() / square });
                // The next value is compared with the one before, with the jump.
                self.forces.iter_mut().for_each(|(_, force)| *force += difference);
            } else {
                self.differences.push_back(difference);
            }
            if self.differences.len() > TUNING.jump_steps {
                self.differences.pop_front();
            }
            self.forces.pop_front();
        }
        self.forces.push_back((time, force));
    }

    /// The polynomial through the last forces.
    fn extrapolated(&self, time: f64) -> f64 {
        let term = |index: usize| -> f64 {
            let (own, force) = self.forces[index];
            let others = self.forces.iter().enumerate().filter(|(other, _)| *other != index);
            force * others.map(|(_, &(other, _))| (time - other) / (own - other)).product::<f64>()
        };
        (0..self.forces.len()).map(term).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watched(force: impl Fn(f64) -> f64) -> Vec<Excitation> {
        let mut watch = Watch::default();
        for step in 1..200 {
            let time = 0.01 * f64::from(step);
            // A mode that follows at once.
            let state = State { position: force(time) / 1e6, velocity: 0.0, acceleration: 0.0 };
            watch.look(state, time, 1e3, false);
        }
        watch.found
    }

    #[test]
    fn force_jump_excites_a_mode_and_smooth_force_does_not() {
        assert!(watched(|t| 30.0 * math::sin(7.0 * t)).is_empty());
        let found = watched(|t| 30.0 * math::sin(7.0 * t) + if t > 1.2345 { 50.0 } else { 0.0 });
        assert!(found.len() == 1 && (found[0].time - 1.24).abs() < 1e-9, "{found:?}");
        assert!((found[0].amplitude / 50e-6 - 1.0).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn vibration_after_short_steps_is_an_excitation() {
        let mut watch = Watch::default();
        let rest = State { position: 0.0, velocity: 0.3, acceleration: 0.0 };
        watch.look(rest, 0.1, 1e3, false);
        watch.look(State { velocity: 1.3, ..rest }, 0.1001, 1e3, true);
        watch.look(rest, 0.2, 1e3, false);
        assert_eq!(watch.found, [Excitation { time: 0.2, amplitude: 1.0 / 1e3 }]);
    }
}
