//! Rank of the constraints at the start: degrees of freedom, redundant constraints, singular starts.

use symdiff::{Expr, Tile, slopes};

use super::general_position::{move_apart, pivot_samples};
use super::rank::{dependent_of_sizes, row_size};
use super::tuning::TUNING;
use crate::assemble::{ConstraintId, System};
use crate::compile::{StartProgram, Tapes};
use crate::simulate::motion_values::motion_values;

/// Degrees of freedom and redundancy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mobility {
    /// Coordinates less independent constraints.
    pub degrees_of_freedom: usize,
    /// Constraints that depend on earlier ones wherever the mechanism moves.
    pub redundant: Vec<ConstraintId>,
    /// Constraints that depend on earlier ones at the start only, which is then a singular configuration.
    pub singular_at_start: Vec<ConstraintId>,
}

/// Rank of Φ_q at the nominal start and, where rows depend on others there, at a configuration in general position near
/// the start. A row that depends on others at the start only is not redundant: the start is singular.
pub fn mobility(system: &System, start: &StartProgram, nominal: &[f64]) -> Mobility {
    let usual = usual_row_sizes(system, start, nominal);
    let dependent = |state: &[f64]| -> Vec<ConstraintId> {
        let rows = dependent_of_sizes(&jacobian_rows(system, start, state), &usual, TUNING.dependent_row);
        rows.into_iter().map(ConstraintId::new).collect()
    };
    let at_start = dependent(nominal);
    let elsewhere = if at_start.is_empty() { None } else { move_apart(system, nominal) };
    let redundant = match elsewhere.map(|state| dependent(&state)) {
        Some(generic) if generic.len() <= at_start.len() => generic,
        _ => at_start.clone(),
    };
    let degrees_of_freedom =
        (system.coordinates_of_motion().count() + redundant.len()).saturating_sub(system.lambda.len());
    let singular_at_start = if at_start.len() > redundant.len() { at_start } else { Vec::new() };
    Mobility { degrees_of_freedom, redundant, singular_at_start }
}

/// The first redundant constraint of velocities that others do not imply, because it follows states of its own: nothing
/// can fulfil it.
pub fn contradiction(
    system: &System,
    start: &StartProgram,
    nominal: &[f64],
    mobility: &Mobility,
) -> Option<ConstraintId> {
    let first = system.constraint.len();
    let suspects: Vec<usize> =
        mobility.redundant.iter().map(|constraint| constraint.number()).filter(|&row| row >= first).collect();
    if suspects.is_empty() || !system.has_states() {
        return None;
    }
    let values = motion_values(system, &start.layout, nominal, 0.0);
    let number = |expr: Expr| values.get(&expr).copied().unwrap_or(0.0);
    let derivatives = slopes(&system.graph, &system.velocity_constraint, &system.v, number);
    let mut rows = jacobian_rows(system, start, nominal);
    for (row, derivatives) in rows[first..].iter_mut().zip(derivatives) {
        let states = derivatives.into_iter().enumerate().filter(|&(column, _)| system.coordinates[column].is_state);
        row.extend(states.map(|(column, value)| (column, value * system.coordinates[column].scale)));
    }
    let usual = usual_row_sizes(system, start, nominal);
    let implied = dependent_of_sizes(&rows, &usual, TUNING.dependent_row);
    suspects.into_iter().find(|row| !implied.contains(row)).map(ConstraintId::new)
}

/// Sizes of the rows of Φ_q around a state: the least of those in general position, with the coordinates' scales. In
/// joint coordinates a row may vanish where the mechanism is singular.
pub fn usual_row_sizes(system: &System, start: &StartProgram, state: &[f64]) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; system.lambda.len()];
    let [_, around @ ..] = pivot_samples(system, &start.layout, state, 0.0);
    for sample in around {
        let sizes = jacobian_rows(system, start, &sample.values).into_iter().map(|row| row_size(&row));
        least.iter_mut().zip(sizes).for_each(|(least, size)| *least = least.min(size));
    }
    least.into_iter().map(|size| if size.is_finite() { size } else { 0.0 }).collect()
}

/// Rows of Φ_q at a state (the layout's registers), per scale of each coordinate: (coordinate, value).
pub fn jacobian_rows(system: &System, start: &StartProgram, state: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let mut tile = Tile::new(1, start.registers(), start.constants());
    tile.values_mut()[..state.len()].copy_from_slice(state);
    tile.run(start.sample());
    tile.run(start.jacobian());
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); system.lambda.len()];
    for &(row, column, register) in &start.jacobian_entries {
        rows[row].push((column, tile.lane(register)[0] * system.coordinates[column].scale));
    }
    rows
}
