//! A constant tension between two points, or a constant force or torque of a joint.
//!
//! ```text
//! F_A = F (r_B − r_A)/ℓ,   F_B = −F_A,   V = F ℓ          N, J
//! at a joint: F pushes its coordinate s up,   V = −F s          N or N m
//! ```
//!
//! Points that coincide have no line between them.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{Preload, TimeOrder};

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, preload: &Preload) -> Result<(), BuildError> {
    let force = m.formula(g, &preload.value, Context::Motion)?;
    let potential = match (preload.between, preload.on) {
        (Some(between), None) => {
            let [a, b] = between.map(|point| m.point(g, point));
            let line = space::sub(g, b.position, a.position);
            let length = space::norm(g, line);
            let density = g.div(force, length);
            let pull = space::scale(g, density, line);
            loads.add_force_pair(g, &b, &a, pull);
            g.mul(force, length)
        }
        (_, Some(on)) => {
            loads.add_joint_effort(g, m, on, force)?;
            let place = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Position);
            let potential = g.mul(force, place);
            g.neg(potential)
        }
        (None, None) => return Ok(()),
    };
    loads.add_potential(g, m, &[force], potential);
    Ok(())
}
