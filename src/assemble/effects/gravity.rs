//! Gravity: the same acceleration on every body.
//!
//! ```text
//! F = m g at the centre of mass,   V = −m g · r_c          N, J
//! ```
//!
//! and on the mass along beams (`flexible`).
//! g in m/s², in the ground's axes: (0, −9.81) pulls down. V is zero at the ground's origin.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::Gravity;

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, gravity: &Gravity) -> Result<(), BuildError> {
    let acceleration = m.vector(g, &gravity.acceleration, Context::Motion)?;
    for (index, body) in m.bodies.iter().enumerate() {
        let weight = space::scale(g, body.mass, acceleration);
        let center = m.point_at(g, index, body.center);
        loads.add_weight(g, m, &center, weight);
        let height = space::dot(g, weight, center.position);
        let potential = g.neg(height);
        loads.add_potential(g, m, &weight, potential);
    }
    m.weigh_beams(g, loads, acceleration)?;
    loads.add_field(g, acceleration);
    Ok(())
}
