//! Equation: any holonomic constraint, drivers included.
//!
//! ```text
//! Φ = left − right = 0          1 row, in the unit of its sides
//! ```
//!
//! The formulas speak of positions, parameters and t, not of velocities. There is no second body, hence no reaction
//! force or torque: both are zero, and the multiplier λ itself (N for metres, N m for radians), with its sign, stands
//! for `joint.force`. −Φ_qᵀ λ acts: with `crank.angle = omega*t` the drive's torque on the crank is −λ.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;

use super::Row;

pub fn rows(g: &Builder, m: &Mechanism, left: &Formula, right: &Formula) -> Result<Vec<Row>, BuildError> {
    let (left, right) = (m.formula(g, left, Context::Positions)?, m.formula(g, right, Context::Positions)?);
    let value = g.sub(left, right);
    Ok(vec![Row { name: "", value, force: space::zero(g), torque: space::zero(g) }])
}
