//! Universal joint: two points coincide, and an axis of the first frame stays perpendicular to one of the second.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 1 row, a pure number
//!     ⎣ a₁ · b₂   ⎦
//! ```
//!
//! a₁ and b₂ are unit vectors along the arms of the cross. The first rows are those of the spherical joint. −Φ_qᵀ λ of the
//! last is the torque λ a₁ × b₂ on the second body and the opposite on the first. It fails where nothing else keeps the arms
//! from lying in each other's shaft: with the shafts at a right angle, the cross can turn on its own.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::assemble::space;
use crate::model::PointRef;

use super::{Pair, Row, spherical, unit_vector};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    between: [PointRef; 2],
    [first, second]: &[[Formula; 3]; 2],
) -> Result<Vec<Row>, BuildError> {
    let mut rows = spherical::rows(g, m, between);
    let pair = Pair::of(g, m, between);
    let first = unit_vector(g, m, first)?;
    let second = unit_vector(g, m, second)?;
    let (first, second) = (pair.outward(g, first), pair.outward_of_second(g, second));
    let value = space::dot(g, first, second);
    let (force, torque) = (space::zero(g), space::cross(g, first, second));
    rows.push(Row { name: "cross", value, force, torque });
    Ok(rows)
}
