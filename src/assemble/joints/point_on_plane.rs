//! Point on plane: the second point moves in a plane fixed in the first body; the bodies may turn in any way.
//!
//! ```text
//! Φ = n₁ · (r_B − r_A) = 0          1 row, m
//! ```
//!
//! n₁ is the plane's unit normal; the plane goes through A. −Φ_qᵀ λ is the force −λ n₁ at B on the second body and the
//! opposite on the first, at the same place.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Pair, Row, unit_vector};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], normal: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    let normal = unit_vector(g, m, normal)?;
    Ok(vec![Pair::of(g, m, between).normal_row(g, "", normal)])
}
