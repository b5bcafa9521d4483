//! Gear: two angles in a fixed ratio.
//!
//! ```text
//! Φ = φ₂ − ratio φ₁ − offset = 0          1 row, rad
//! ```
//!
//! φ is the angle of a body about z, or of a joint about its axis. An external pair has a negative ratio. −Φ_qᵀ λ is the
//! torque −λ on the second and +ratio λ on the first; the difference is carried by whatever holds the axles, so this is no
//! pair of action and reaction. A torque on a joint's angle acts on its second body, and the opposite on its first. Tooth
//! forces on the axles are not part of it: the reaction has no force.

use symdiff::{Builder, Formula};

use crate::assemble::body::ANGLE;
use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{JointCoordinate, TimeOrder, Turning};

use super::{Row, axis_in_ground};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    between: [Turning; 2],
    ratio: &Formula,
    offset: &Formula,
) -> Result<Vec<Row>, BuildError> {
    let (ratio, offset) = (m.formula(g, ratio, Context::Time)?, m.formula(g, offset, Context::Time)?);
    let [first, second] = between.map(|turning| match turning {
        Turning::Body(body) => m.bodies[body].position[ANGLE],
        Turning::Joint(joint) => m.joint_coordinate(g, joint, JointCoordinate::Angle, TimeOrder::Position),
    });
    let driven = g.mul(ratio, first);
    let difference = g.sub(second, driven);
    let value = g.sub(difference, offset);
    let axis = match between[1] {
        Turning::Body(_) => space::along(g, 2),
        Turning::Joint(joint) => axis_in_ground(g, m, joint, JointCoordinate::Angle)?,
    };
    Ok(vec![Row { name: "", value, force: space::zero(g), torque: space::neg(g, axis) }])
}
