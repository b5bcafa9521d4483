//! Cylindrical joint: the second point slides along an axis of the first frame, and the frames turn about it.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 nᵢ · e         ⎦
//! ```
//!
//! The nᵢ are the axis' unit normals; it goes through A. −Φ_qᵀ λ of the first rows is the force −λ nᵢ at B on the second
//! body and the opposite on the first, at the same place; the others carry the torque across the axis.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Pair, Row, unit_vector};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    let axis = unit_vector(g, m, axis)?;
    let pair = Pair::of(g, m, between);
    let mut rows = pair.on_line(g, m, axis).to_vec();
    rows.extend(pair.coaxial(g, m, axis));
    Ok(rows)
}
