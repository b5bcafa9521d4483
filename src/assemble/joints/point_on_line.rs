//! Point on line: the second point slides along a line fixed in the first body; the bodies may turn in any way.
//!
//! ```text
//! Φ = nᵢ · (r_B − r_A) = 0          2 rows, m; in the plane, where it is a pin in a slot, 1
//! ```
//!
//! The nᵢ are the line's unit normals; it goes through A and does not end. −Φ_qᵀ λ is the force −λ nᵢ at B on the second
//! body and the opposite on the first, at the same place.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Pair, Row, prismatic, unit_vector};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    if !m.is_spatial() {
        return Ok(vec![Row { name: "", ..prismatic::normal_row(g, m, between, axis)? }]);
    }
    let axis = unit_vector(g, m, axis)?;
    Ok(Pair::of(g, m, between).on_line(g, m, axis).to_vec())
}
