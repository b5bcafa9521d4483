//! Screw joint: a cylindrical joint that advances as it turns.
//!
//! ```text
//! Φ = ⎡ the rows of the cylindrical joint           ⎤ = 0          4 rows; 1 row, m
//!     ⎣ a₁ · (r_B − r_A) − (pitch / 2π) φ           ⎦
//! ```
//!
//! a₁ is the axis, φ the joint's angle, never wrapped, and the pitch the advance in a turn, positive for a right-handed
//! thread. −Φ_qᵀ λ of the last row is the force −λ a₁ at B and the torque +λ (pitch / 2π) a₁ on the second body, and the
//! opposite on the first.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{JointCoordinate, PointRef, TimeOrder};

use super::{Pair, Row, cylindrical, unit_vector};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    joint: usize,
    between: [PointRef; 2],
    axis: &[Formula; 3],
    pitch: &Formula,
) -> Result<Vec<Row>, BuildError> {
    let mut rows = cylindrical::rows(g, m, between, axis)?;
    let axis = unit_vector(g, m, axis)?;
    let pitch = m.formula(g, pitch, Context::Time)?;
    let advance = g.scale(std::f64::consts::TAU.recip(), pitch);
    let pair = Pair::of(g, m, between);
    let angle = m.joint_coordinate(g, joint, JointCoordinate::Angle, TimeOrder::Position);
    let (moved, wanted) = (pair.displacement(g, axis), g.mul(advance, angle));
    let value = g.sub(moved, wanted);
    let along = pair.outward(g, axis);
    let (force, torque) = (space::neg(g, along), space::scale(g, advance, along));
    rows.push(Row { name: "advance", value, force, torque });
    Ok(rows)
}
