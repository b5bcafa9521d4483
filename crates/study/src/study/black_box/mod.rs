//! A program as an ensemble: its answers stand where simulations of a mechanism do.
//!
//! `source` asks it, and makes the model's outputs of its answers, which the ensemble gives to methods (`answered`
//! there); `nominal` asks first, `repeated` once more, for its noise.

mod nominal;
mod repeated;
pub(super) mod source;
pub(crate) mod tuning;

pub(super) use nominal::ask_nominal;
pub(super) use repeated::repeat;

use super::problem::Study;
use crate::methods::Refusal;
use crate::model::{Analysis, Description};
use crate::numerics::Sample;
use crate::simulate::SimulationError;

/// Refuses a question about bodies to a program and to dimensions alone.
///
/// # Errors
/// If there is no mechanism.
pub fn needs_mechanism(description: &Description, question: &str) -> Result<(), Refusal> {
    match description.analysis {
        Analysis::Dimensions => {
            Err(Refusal(format!("{question} needs a mechanism, and here are formulas of dimensions alone")))
        }
        _ => needs_equations(description, question),
    }
}

/// Refuses a question about equations to a program.
///
/// # Errors
/// If a program answers instead of equations.
pub(super) fn needs_equations(description: &Description, question: &str) -> Result<(), Refusal> {
    match &description.black_box {
        None => Ok(()),
        Some(own) => {
            let place = &own.place;
            Err(Refusal(format!("{place}: {question} needs a mechanism, and here a black box answers instead of one")))
        }
    }
}

/// Error of a sample for which the program has no answer.
pub(super) fn no_answer(study: &Study, sample: &Sample, why: String) -> SimulationError {
    let place = study.description.black_box.as_ref().map(|own| own.place.clone()).unwrap_or_default();
    SimulationError::NoAnswer { place, why, parameters: study.simulator.with_names(sample) }
}
