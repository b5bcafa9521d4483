//! Rack and pinion: a displacement in a fixed ratio to an angle.
//!
//! ```text
//! Φ = s − radius φ − offset = 0          1 row, m
//! ```
//!
//! φ is the angle of the pinion's joint, s the displacement of the rack's. −Φ_qᵀ λ is the force −λ along the rack's axis on
//! the second body of its joint and the torque +radius λ about the pinion's axis on the second body of its; the opposites
//! act on the first bodies. The reaction is the force on the rack.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{JointCoordinate, TimeOrder};

use super::{Row, axis_in_ground};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    [pinion, rack]: [usize; 2],
    radius: &Formula,
    offset: &Formula,
) -> Result<Vec<Row>, BuildError> {
    let (radius, offset) = (m.formula(g, radius, Context::Time)?, m.formula(g, offset, Context::Time)?);
    let angle = m.joint_coordinate(g, pinion, JointCoordinate::Angle, TimeOrder::Position);
    let moved = m.joint_coordinate(g, rack, JointCoordinate::Displacement, TimeOrder::Position);
    let driven = g.mul(radius, angle);
    let difference = g.sub(moved, driven);
    let value = g.sub(difference, offset);
    let axis = axis_in_ground(g, m, rack, JointCoordinate::Displacement)?;
    Ok(vec![Row { name: "", value, force: space::neg(g, axis), torque: space::zero(g) }])
}
