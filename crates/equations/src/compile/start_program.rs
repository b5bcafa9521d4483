//! The tapes of a consistent start.

use symdiff::{Lowered, Tape};

use super::layout::Layout;
use super::nearest::OpenStart;
use super::start_equations::Residual;
use super::tapes::Tapes;
use crate::assemble::{SampledState, System};
use crate::compile::tuning::TUNING;

/// Tapes for the start of a tile of samples; states and corrections are in the registers of [`Layout`].
#[derive(Clone, Debug)]
pub struct StartProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// Φ, m, and the conditions on positions, after [`StartProgram::position`].
    pub constraint: Vec<Residual>,
    /// Φ̇, m, and the conditions on velocities, after [`StartProgram::velocity`].
    pub constraint_rate: Vec<Residual>,
    /// Registers of the outputs after [`StartProgram::observe`].
    pub outputs: Vec<usize>,
    /// States that change at instants, after [`StartProgram::sampling`].
    pub sampled: Vec<SampledValue>,
    /// Φ_q's entries (constraint, coordinate, register) after [`StartProgram::jacobian`].
    pub jacobian_entries: Vec<(usize, usize, usize)>,
    /// Coordinates nearest to rest.
    pub open: OpenStart,
    pub(super) lowered: Lowered,
}

/// A state that changes at the instants 0, T, 2 T, … only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledValue {
    /// Its register: that of a velocity.
    pub state: usize,
    /// Register of the new value.
    pub value: usize,
    /// T, s.
    pub period: f64,
}

impl SampledValue {
    /// The sampled values of a system, whose new values are in these registers.
    pub(super) fn all(system: &System, layout: &Layout, registers: Vec<usize>) -> Vec<Self> {
        let states = system.sampled.iter().zip(registers);
        let value = |(sampled, value): (&SampledState, usize)| Self {
            state: layout.v.start + sampled.coordinate,
            value,
            period: sampled.period,
        };
        states.map(value).collect()
    }

    /// Whether a time, s, is one of its instants.
    pub fn is_due(&self, time: f64) -> bool {
        let periods = time / self.period;
        (periods - periods.round()).abs() <= TUNING.instant_rounding
    }

    /// Its first instant after a time and before another.
    pub fn due_between(&self, from: f64, to: f64) -> Option<f64> {
        let number = (from / self.period + TUNING.instant_rounding).floor() + 1.0;
        (number < to / self.period - TUNING.instant_rounding).then_some(number * self.period)
    }
}

// Numbers of the tapes.
const GIVEN: usize = 0;
const GUESS: usize = 1;
pub(super) const POSITION: usize = 2;
pub(super) const VELOCITY: usize = 3;
const ACCELERATION: usize = 4;
pub(super) const JACOBIAN: usize = 5;
pub(super) const OBSERVE: usize = 6;
const PROJECTION: usize = 7;
pub(super) const SAMPLING: usize = 8;

impl Tapes for StartProgram {
    fn lowered(&self) -> &Lowered {
        &self.lowered
    }
}

impl StartProgram {
    /// Sets the positions and velocities that are given.
    pub fn given(&self) -> &Tape {
        &self.lowered.kernels[GIVEN]
    }

    /// Sets all positions to the guess.
    pub fn guess(&self) -> &Tape {
        &self.lowered.kernels[GUESS]
    }

    /// Correction of the positions (first n of `correction`), and Φ.
    pub fn position(&self) -> &Tape {
        &self.lowered.kernels[POSITION]
    }

    /// Correction of the velocities (first n of `correction`), and Φ̇.
    pub fn velocity(&self) -> &Tape {
        &self.lowered.kernels[VELOCITY]
    }

    /// Correction of accelerations and multipliers.
    pub fn acceleration(&self) -> &Tape {
        &self.lowered.kernels[ACCELERATION]
    }

    /// Correction of the velocities of a motion (first n of `correction`): impulses of the constraints that make them
    /// consistent.
    pub fn projection(&self) -> &Tape {
        &self.lowered.kernels[PROJECTION]
    }

    /// Outputs of the state.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// New values of the states that change at instants.
    pub fn sampling(&self) -> &Tape {
        &self.lowered.kernels[SAMPLING]
    }

    /// Φ_q.
    pub fn jacobian(&self) -> &Tape {
        &self.lowered.kernels[JACOBIAN]
    }
}
