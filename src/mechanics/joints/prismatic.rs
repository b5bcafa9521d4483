//! Prismatic joint: the second point slides along a line fixed in the first body, without relative rotation.
//!
//! ```text
//! Φ = ⎡ n₁ · (r_B − r_A)   ⎤ = 0          1 row, m; 1 row, rad
//!     ⎣ θ₂ − θ₁ − angle    ⎦
//! ```
//!
//! n₁ = R₁ (axis/|axis|)⊥ is the line's unit normal; the line goes through A. −Φ_qᵀ λ of the first row is the force −λ
//! n₁ at B on the second body and the opposite on the first, at the same place, for B slides: its arm on the first body
//! is r_B − r₁. That of the second row is the torque −λ on the second body and +λ on the first. An axis of length zero
//! has no normal: the rows are not numbers then.

use symdiff::{Formula, Graph};

use crate::mechanics::body::ANGLE;
use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::{Context, Mechanism};
use crate::mechanics::plane;
use crate::model::PointRef;

use super::Row;

pub fn rows(
    g: &mut Graph,
    m: &Mechanism,
    between: [PointRef; 2],
    axis: &[Formula; 2],
    angle: &Formula,
) -> Result<Vec<Row>, BuildError> {
    Ok(vec![normal_row(g, m, between, axis)?, angle_row(g, m, between, angle)?])
}

/// n₁ · (r_B − r_A).
pub fn normal_row(
    g: &mut Graph,
    m: &Mechanism,
    between: [PointRef; 2],
    axis: &[Formula; 2],
) -> Result<Row, BuildError> {
    let axis = m.vector(g, axis, Context::Time)?;
    let axis = plane::unit(g, axis);
    let normal = plane::perpendicular(g, axis);
    let normal = m.bodies[between[0].body].rotate(g, normal);
    let [a, b] = between.map(|point| m.point(g, point));
    let offset = plane::sub(g, b.position, a.position);
    let value = plane::dot(g, normal, offset);
    Ok(Row { name: "normal", value, force: plane::neg(g, normal), torque: g.constant(0.0) })
}

/// θ₂ − θ₁ − angle.
pub fn angle_row(g: &mut Graph, m: &Mechanism, between: [PointRef; 2], angle: &Formula) -> Result<Row, BuildError> {
    let angle = m.formula(g, angle, Context::Time)?;
    let [first, second] = between.map(|point| m.bodies[point.body].position[ANGLE]);
    let turned = g.sub(second, first);
    let value = g.sub(turned, angle);
    Ok(Row { name: "angle", value, force: plane::zero(g), torque: g.constant(-1.0) })
}
