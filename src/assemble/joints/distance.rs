//! Distance joint: two points keep a distance d, as if by a massless rod.
//!
//! ```text
//! Φ = (|r|² − d²) / (2 d) = 0,   r = r_B − r_A          1 row, m
//! ```
//!
//! ∂Φ/∂r_B = r/d is the unit vector of the rod, so λ is the rod's tension, N: −Φ_qᵀ λ is −λ r/d at B and +λ r/d at A,
//! and λ > 0 pulls the points together. Φ is |r| − d to first order and has no root. It fails at d = 0: two coincident
//! points are a revolute or spherical joint.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::PointRef;

use super::Row;

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2], length: &Formula) -> Result<Vec<Row>, BuildError> {
    let length = m.formula(g, length, Context::Time)?;
    let [a, b] = between.map(|point| m.point(g, point));
    let line = space::sub(g, b.position, a.position);
    let (square, wanted) = (space::dot(g, line, line), g.mul(length, length));
    let difference = g.sub(square, wanted);
    let doubled = g.scale(2.0, length);
    let pull = line.map(|component| g.div(component, length));
    let value = g.div(difference, doubled);
    Ok(vec![Row { name: "", value, force: space::neg(g, pull), torque: space::zero(g) }])
}
