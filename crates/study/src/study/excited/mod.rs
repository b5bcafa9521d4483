//! Bounds over functions of the time: excitations of which only limits are known.
//!
//! As a constant, an excitation is an uncertain parameter, and methods bound it with the others. As a function, it is
//! an input of equations that are compiled once more: a level and a slope in each step (`motions`). The gradient of an
//! output in a row by all of them is its kernel, from one run backwards. It names the worst function (`climb`) of a
//! class that `limits` evaluates. Every end is attained by a function (`ends`); it
//! widens the methods' bands. `switches` has the instants of the farthest ones, `values` ends of
//! reduced outputs.

mod climb;
mod ends;
mod limits;
mod motions;
mod point;
mod switches;
pub(crate) mod tuning;
mod values;

use super::RunError;
use super::bounding::{FunctionEnds, Outcome, timed};
use super::formulation::compiled;
use super::problem::Study;
use crate::assemble::Questions;
use crate::methods::MethodResult;
use crate::model::Formulation;
use crate::simulate::{Schedule, SimulationError};
use ends::ends;
pub(super) use limits::Limits;
use switches::settle_switches;
use values::ends_of_values;

/// Whether an excitation acts.
pub(super) fn is_excited(study: &Study) -> bool {
    !study.simulator.system.analysis.visits() && study.simulator.system.is_excited
}

/// Searches the ends of all outputs over all functions; `None` if no excitation acts, and at an interruption.
///
/// # Errors
/// If the equations cannot be compiled, or the nominal motion cannot be simulated.
pub(super) fn excited(study: &Study, schedule: &Schedule) -> Result<Option<(Outcome, FunctionEnds)>, RunError> {
    if !is_excited(study) || study.interruption.is_asked() {
        return Ok(None);
    }
    (study.stage)("any function");
    let joint = study.simulator.system.formulation.joint;
    let formulation = if joint { Formulation::Joint } else { Formulation::Absolute };
    let questions = Questions { as_functions: true, formulation, ..Questions::of(study.description) };
    let simulator = compiled(&questions)?;
    let found = timed(schedule, "any function", || {
        let (mut found, mut motions) = ends(study, &simulator, schedule)?;
        settle_switches(&mut motions, &mut found)?;
        if let Some(store) = study.store.get() {
            found.of_values = Some(Box::new(ends_of_values(&mut motions, &found, store)?));
        }
        Ok((MethodResult { simulations: motions.count, ..MethodResult::default() }, found))
    });
    match found {
        Err(SimulationError::Interrupted) => Ok(None),
        found => Ok(Some(found?)),
    }
}
