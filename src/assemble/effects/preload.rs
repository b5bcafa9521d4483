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
use crate::assemble::mechanism::Mechanism;
use crate::model::{Preload, TimeOrder};
use crate::multibody::Vector;

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, preload: &Preload) -> Result<(), BuildError> {
    let force = m.value(g, &preload.value)?;
    let potential = match (preload.between, preload.on) {
        (Some(between), None) => {
            let [a, b] = between.map(|point| m.point(g, point));
            let line = Vector::of(g, b.position) - Vector::of(g, a.position);
            let length = line.norm();
            loads.add_force_pair(g, &b, &a, (force / length * line).exprs());
            force * length
        }
        (_, Some(on)) => {
            loads.add_joint_effort(g, m, on, force.expr())?;
            let place = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Position);
            -(force * g.scalar(place))
        }
        (None, None) => return Ok(()),
    };
    loads.add_potential(g, m, &[force.expr()], potential.expr());
    Ok(())
}
