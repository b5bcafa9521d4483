//! Co-simulation: the unit takes steps of its own between rows.

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
    for pair in times.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let count = steps(to - from, step);
        let time = |index: usize| if index == count { to } else { from + index as f64 * ((to - from) / count as f64) };
        for index in 0..count {
            // Rows at equal distances get steps of one length: a unit's own clock is not asked for a last digit more.
            instance.step(time(index), (to - from) / count as f64)?;
        }
        row(instance)?;
    }
    Ok(())
}

/// Number of equal steps, no longer than one of `step`, that fill a distance.
pub fn steps(distance: f64, step: f64) -> usize {
    // A distance that is a multiple but for rounding is one.
    ((distance / step - 1e-9).ceil()).max(1.0) as usize
}
