//! What a step of one sample takes.

use crate::simulate::Simulator;

/// Time of an instruction of one sample, s: a processor of today with all its lanes, so that a refused study does take
/// so long.
pub const INSTRUCTION_SECONDS: f64 = 2e-10;

/// Corrections of a step after the first one.
const FURTHER_CORRECTIONS: f64 = 1.0;

/// Instructions of a step of one sample.
pub fn instructions_of_step(simulator: &Simulator) -> f64 {
    let program = &simulator.program;
    program.instructions() as f64 + FURTHER_CORRECTIONS * program.correct().len() as f64
}
