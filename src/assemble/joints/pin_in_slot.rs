//! Pin in slot: the second point slides along a line fixed in the first body, and may turn about the frames' z.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 e_x, 2 e_y     ⎦              in the plane 1 row, m
//! ```
//!
//! The nᵢ are the slot's unit normals; the slot goes through A and does not end. −Φ_qᵀ λ of the first rows is the force −λ
//! nᵢ at B on the second body (the pin) and the opposite on the first (the slot), at the same place. In the plane the first
//! row of the prismatic joint.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::assemble::space;
use crate::model::PointRef;

use super::{Pair, Row, point_on_line};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    let mut rows = point_on_line::rows(g, m, between, axis)?;
    if m.is_spatial() {
        let turning = space::along(g, 2);
        rows.extend(Pair::of(g, m, between).coaxial(g, m, turning));
    }
    Ok(rows)
}
