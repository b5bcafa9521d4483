//! Rank of the constraints at the start: degrees of freedom, redundant constraints, singular starts.

use symdiff::Tile;

use super::general_position::move_apart;
use super::rank::dependent_rows;
use crate::assemble::{ConstraintId, System};
use crate::compile::{StartProgram, Tapes};

/// Rows of Φ_q that are independent of the others by less than this (scaled) count as dependent.
pub const DEPENDENT: f64 = 1e-8;

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
    let at_start = dependent_constraints(system, start, nominal);
    let elsewhere = if at_start.is_empty() { None } else { move_apart(system, nominal) };
    let redundant = match elsewhere.map(|state| dependent_constraints(system, start, &state)) {
        Some(generic) if generic.len() <= at_start.len() => generic,
        _ => at_start.clone(),
    };
    let degrees_of_freedom =
        (system.coordinates_of_motion().count() + redundant.len()).saturating_sub(system.lambda.len());
    let singular_at_start = if at_start.len() > redundant.len() { at_start } else { Vec::new() };
    Mobility { degrees_of_freedom, redundant, singular_at_start }
}

/// Constraints that depend on earlier ones at a state.
fn dependent_constraints(system: &System, start: &StartProgram, state: &[f64]) -> Vec<ConstraintId> {
    let rows = dependent_rows(&jacobian_rows(system, start, state), DEPENDENT);
    rows.into_iter().map(ConstraintId::new).collect()
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
