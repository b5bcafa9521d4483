//! Co-simulation: the unit takes steps of its own between rows.

use super::steps::Steps;
use crate::native::{Fault, Instance};

/// Moves an initialised instance from row to row; `row` is called in each. With `step`, s, communication steps are no
/// longer than that.
///
/// # Errors
/// Where a step fails.
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
            // Only the last row may be where it ends.
            if let Some(time) = ended {
                return Err(Fault::Terminated(time));
            }
            // Rows at equal distances get steps of one length: a unit's own clock is not asked for a last digit more.
            let ends = instance.step(steps.time(index), steps.size())?;
            ended = ends.then(|| steps.time(index + 1));
        }
        row(instance)?;
    }
    Ok(())
}
