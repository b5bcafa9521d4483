//! Fixed joint: two bodies are welded.
//!
//! ```text
//! Φ = ⎡ r_A − r_B         ⎤ = 0          2 rows, m; 1 row, rad
//!     ⎣ θ₂ − θ₁ − angle   ⎦
//! ```
//!
//! The first two rows are those of the revolute joint: λ is the force on the second body, at B. −Φ_qᵀ λ of the third is
//! the torque −λ on the second body and +λ on the first.

use symdiff::{Formula, Graph};

use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::Mechanism;
use crate::model::PointRef;

use super::{Row, prismatic, revolute};

pub fn rows(g: &mut Graph, m: &Mechanism, between: [PointRef; 2], angle: &Formula) -> Result<Vec<Row>, BuildError> {
    let mut rows = revolute::rows(g, m, between);
    rows.push(prismatic::angle_row(g, m, between, angle)?);
    Ok(rows)
}
