//! Newton's method on the instants at which the farthest functions switch.
//!
//! Functions of cells switch where cells end. At an instant τ at which one switches, an end changes by twice the kernel
//! there; the kernel is straight between the middles of cells, and its zero is the next τ. Steps then end there, as
//! long as the end grows.

use super::climb::FunctionClimb;
use super::motions::{ExcitedMotions, functional, in_row};
use super::point::Point;
use super::tuning::TUNING;
use crate::simulate::{Gradient, SimulationError};
use crate::study::bounding::{FunctionEnd, FunctionEnds, WorstFunction};

/// Settles the switches of the functions under which each output is least, greatest and furthest.
///
/// # Errors
/// As for gradients.
pub fn settle_switches(motions: &mut ExcitedMotions, found: &mut FunctionEnds) -> Result<(), SimulationError> {
    for output in 0..motions.outputs() {
        for is_upper in [false, true] {
            let Some(own) = found.extremes[output][usize::from(is_upper)].clone() else { continue };
            let known = found.end(own.row, output, is_upper);
            let Some((function, end)) = settled(motions, &own, output, is_upper)? else { continue };
            let open = end.open.min(known.open);
            found.note(own.row, output, is_upper, FunctionEnd { open, ..end });
            let is_worst = |worst: &WorstFunction| worst.row == own.row && worst.value == own.value;
            if let Some((gain, worst)) = found.worst[output].as_mut().filter(|(_, worst)| is_worst(worst)) {
                *gain += (end.value - own.value).abs();
                *worst = function.clone();
            }
            found.extremes[output][usize::from(is_upper)] = Some(function);
        }
    }
    Ok(())
}

/// A function with its switches between the ends of cells, and the end there; `None` if it is no further.
fn settled(
    motions: &mut ExcitedMotions,
    own: &WorstFunction,
    output: usize,
    is_upper: bool,
) -> Result<Option<(WorstFunction, FunctionEnd)>, SimulationError> {
    let sign = if is_upper { 1.0 } else { -1.0 };
    let mut point = Point { xi: motions.study.domain.xi(&own.sample), functions: own.cells.clone() };
    let mut ends = own.ends.clone();
    let mut found: Option<(WorstFunction, FunctionEnd)> = None;
    let mut gradient = motions.gradients(&[(&point, in_row(own.row, output))])?.swap_remove(0);
    for _ in 0..TUNING.newton_rounds {
        let times = switches(motions, &gradient, &ends, &point, sign);
        let mut finer = motions.ending_at_times(&times);
        if times.is_empty() || finer.ends.len() == motions.ends.len() {
            break;
        }
        point = point.later(0.0, &ends, &finer.ends);
        ends = finer.ends.clone();
        // The kernel on these cells names the function: the one before may be none of the class on them.
        let mut climb = FunctionClimb::new(own.row, output, sign, point.clone());
        gradient = finer.gradients(&[(&point, in_row(own.row, output))])?.swap_remove(0);
        climb.take(&gradient, &finer);
        let Some(next) = climb.next else { break };
        let mut climb = FunctionClimb::new(own.row, output, sign, next);
        if let Some(asked) = climb.asked() {
            gradient = finer.gradients(&[asked])?.swap_remove(0);
        }
        climb.take(&gradient, &finer);
        motions.count += finer.count;
        let Some((best, reached)) = climb.best.clone() else { break };
        let before = found.as_ref().map_or(sign * own.value, |(_, end)| sign * end.value);
        // NaN ends it too.
        if reached.partial_cmp(&before) != Some(std::cmp::Ordering::Greater) {
            break;
        }
        let value = sign * reached;
        found = Some((finer.function(own.row, value, &best), FunctionEnd { value, open: climb.open() }));
        point = best;
    }
    Ok(found)
}

/// When the kernel says that functions switch, s.
fn switches(motions: &ExcitedMotions, found: &Gradient, ends: &[f64], point: &Point, sign: f64) -> Vec<f64> {
    let classes = motions.classes(&point.xi);
    let inputs = classes.len();
    let by_class = classes.iter().enumerate();
    by_class.flat_map(|(input, class)| class.switches(ends, &functional(found, sign, input, inputs))).collect()
}
