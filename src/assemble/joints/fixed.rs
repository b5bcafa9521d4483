//! Fixed joint: two bodies are welded.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 3 rows, rad (see `pair`)
//!     ⎣ 2 e       ⎦
//! in the plane ⎡ r_A − r_B        ⎤ = 0          2 rows, m; 1 row, rad
//!              ⎣ θ₂ − θ₁ − angle  ⎦
//! ```
//!
//! The second frame is turned by `angle` about the first's z. The first rows are those of the spherical joint: λ is the
//! force on the second body, at B. −Φ_qᵀ λ of the others is a torque −λ on the second body and +λ on the first, in the axes
//! of the turned first frame.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::PointRef;

use super::{Pair, Row, prismatic, spherical};

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], angle: &Formula) -> Result<Vec<Row>, BuildError> {
    let mut rows = spherical::rows(g, m, between);
    if m.is_spatial() {
        let angle = m.formula(g, angle, Context::Time)?;
        rows.extend(Pair::of(g, m, between).turned(g, angle).parallel(g));
    } else {
        rows.push(prismatic::angle_row(g, m, between, angle)?);
    }
    Ok(rows)
}
