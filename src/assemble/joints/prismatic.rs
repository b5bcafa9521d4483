//! Prismatic joint: the second point slides along a line fixed in the first body, without relative rotation.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 3 rows, rad (see `pair`)
//!     ⎣ 2 e              ⎦
//! in the plane ⎡ n₁ · (r_B − r_A)  ⎤ = 0          1 row, m; 1 row, rad
//!              ⎣ θ₂ − θ₁ − angle   ⎦
//! ```
//!
//! The nᵢ are the line's unit normals, fixed in the first body, in the plane n₁ = R₁ (axis/|axis|)⊥; the line goes through
//! A; the second frame is turned by `angle` about the first's z. −Φ_qᵀ λ of the first rows is the force −λ nᵢ at B on the
//! second body and the opposite on the first, at the same place, for B slides: its arm on the first body is r_B − r₁. That
//! of the others is a torque −λ on the second body and +λ on the first. An axis of length zero has no normal: the rows are
//! not numbers then.

use symdiff::{Builder, Formula};

use crate::assemble::body::ANGLE;
use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::PointRef;

use super::{Pair, Row, unit_vector};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    between: [PointRef; 2],
    axis: &[Formula; 3],
    angle: &Formula,
) -> Result<Vec<Row>, BuildError> {
    if !m.is_spatial() {
        return Ok(vec![normal_row(g, m, between, axis)?, angle_row(g, m, between, angle)?]);
    }
    let axis = unit_vector(g, m, axis)?;
    let angle = m.formula(g, angle, Context::Time)?;
    let pair = Pair::of(g, m, between);
    let mut rows = pair.on_line(g, m, axis).to_vec();
    rows.extend(pair.turned(g, angle).parallel(g));
    Ok(rows)
}

/// n₁ · (r_B − r_A), n₁ the axis turned by a right angle in the plane.
pub fn normal_row(g: &Builder, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 3]) -> Result<Row, BuildError> {
    let axis = unit_vector(g, m, axis)?;
    let normal = space::perpendicular(g, axis);
    let normal = m.bodies[between[0].body].rotate(g, normal);
    let [a, b] = between.map(|point| m.point(g, point));
    let offset = space::sub(g, b.position, a.position);
    let value = space::dot(g, normal, offset);
    Ok(Row { name: "normal", value, force: space::neg(g, normal), torque: space::zero(g) })
}

/// θ₂ − θ₁ − angle.
pub fn angle_row(g: &Builder, m: &Mechanism, between: [PointRef; 2], angle: &Formula) -> Result<Row, BuildError> {
    let angle = m.formula(g, angle, Context::Time)?;
    let [first, second] = between.map(|point| m.bodies[point.body].position[ANGLE]);
    let turned = g.sub(second, first);
    let value = g.sub(turned, angle);
    let about = space::along(g, 2);
    Ok(Row { name: "angle", value, force: space::zero(g), torque: space::neg(g, about) })
}
