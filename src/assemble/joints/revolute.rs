//! Revolute joint: two points coincide, and the frames turn about an axis against one another.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 2 rows, rad (n₁, n₂ normal to the axis; see `pair`)
//!     ⎣ 2 nᵢ · e  ⎦              in the plane 2 rows, m
//! ```
//!
//! A on the first, B on the second body. −Φ_qᵀ λ of the first rows is the force +λ at B on the second body and −λ at A on
//! the first: λ is the pin's force on the second body, in the ground's axes. The others carry the torque across the axis.
//! Nothing fails; with both points on held coordinates a row vanishes.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Pair, Row, spherical, unit_vector};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], axis: &[Formula; 3]) -> Result<Vec<Row>, BuildError> {
    let mut rows = spherical::rows(g, m, between);
    if m.is_spatial() {
        let axis = unit_vector(g, m, axis)?;
        rows.extend(Pair::of(g, m, between).coaxial(g, m, axis));
    }
    Ok(rows)
}
