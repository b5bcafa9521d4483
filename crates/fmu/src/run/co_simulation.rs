//! Co-simulation: the unit takes steps of its own between rows.

use super::steps::Steps;
use crate::native::{Fault, Instance};

/// Moves an initialised instance from row to row, calling `row` at each. Communication steps are at most `step` long,
/// s.
///
/// # Errors
/// If a step fails.
pub fn run(
    instance: &mut dyn Instance,
    times: &[f64],
    step: f64,
    row: &mut dyn FnMut(&mut dyn Instance) -> Result<(), Fault>,
) -> Result<(), Fault> {
    row(instance)?;
    let mut ended = None;
    for pair in times.windows(2) {
        let steps = Steps::between(pair[0], pair[1], step);
        for index in 0..steps.count {
            // The motion may end at the last row only.
            if let Some(time) = ended {
                return Err(Fault::Terminated(time));
            }
            // Equidistant rows get steps of one length, not corrected for rounding of the unit's own clock.
            let ends = instance.step(steps.time(index), steps.size())?;
            ended = ends.then(|| steps.time(index + 1));
        }
        row(instance)?;
    }
    Ok(())
}
