//! Pin in slot: the second point slides along a line fixed in the first body, and may turn.
//!
//! ```text
//! Φ = n₁ · (r_B − r_A) = 0          1 row, m
//! ```
//!
//! n₁ = R₁ (axis/|axis|)⊥ is the slot's unit normal; the slot goes through A and does not end. −Φ_qᵀ λ is the force −λ
//! n₁ at B on the second body (the pin) and the opposite on the first (the slot), at the same place. The first row of
//! the prismatic joint.

use symdiff::{Formula, Graph};

use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Row, prismatic};

pub fn rows(g: &mut Graph, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 2]) -> Result<Vec<Row>, BuildError> {
    Ok(vec![Row { name: "", ..prismatic::normal_row(g, m, between, axis)? }])
}
