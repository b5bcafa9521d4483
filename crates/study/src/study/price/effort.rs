//! Instructions of a step of one sample.

use crate::simulate::Simulator;
use crate::study::price::tuning::TUNING;

/// Instructions of a step of one sample.
pub fn instructions_of_step(simulator: &Simulator) -> f64 {
    let program = &simulator.program;
    program.instructions() as f64 + TUNING.further_corrections * program.correct().len() as f64
}
