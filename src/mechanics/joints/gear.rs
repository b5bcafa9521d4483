//! Gear: two angles in a fixed ratio.
//!
//! ```text
//! Φ = θ₂ − ratio θ₁ − offset = 0          1 row, rad
//! ```
//!
//! An external pair has a negative ratio. −Φ_qᵀ λ is the torque −λ on the second body and +ratio λ on the first; the
//! difference is carried by whatever holds the axles, so this is no pair of action and reaction. Tooth forces on the
//! axles are not part of it: the reaction has no force.

use symdiff::{Formula, Graph};

use crate::mechanics::body::ANGLE;
use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::{Context, Mechanism};
use crate::mechanics::plane;

use super::Row;

pub fn rows(
    g: &mut Graph,
    m: &Mechanism,
    between: [usize; 2],
    ratio: &Formula,
    offset: &Formula,
) -> Result<Vec<Row>, BuildError> {
    let (ratio, offset) = (m.formula(g, ratio, Context::Time)?, m.formula(g, offset, Context::Time)?);
    let [first, second] = between.map(|body| m.bodies[body].position[ANGLE]);
    let driven = g.mul(ratio, first);
    let difference = g.sub(second, driven);
    let value = g.sub(difference, offset);
    Ok(vec![Row { name: "", value, force: plane::zero(g), torque: g.constant(-1.0) }])
}
