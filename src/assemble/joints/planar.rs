//! Planar joint: the second point moves in a plane fixed in the first body, and the frames turn about its normal.
//!
//! ```text
//! Φ = ⎡ n₁ · (r_B − r_A) ⎤ = 0          1 row, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 nᵢ · e         ⎦
//! ```
//!
//! n₁ is the plane's unit normal, through A, and the nᵢ are normal to it. −Φ_qᵀ λ of the first row is the force −λ n₁ at B
//! on the second body and the opposite on the first, at the same place; the others carry the torque across the normal.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Pair, Row, unit_vector};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], normal: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    let normal = unit_vector(g, m, normal)?;
    let pair = Pair::of(g, m, between);
    let mut rows = vec![pair.normal_row(g, "normal", normal)];
    rows.extend(pair.coaxial(g, m, normal));
    Ok(rows)
}
