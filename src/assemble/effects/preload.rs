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
use crate::model::{Preload, Preloaded, TimeOrder};

use super::{Loads, Sheet};

/// For `mbint explain --effects`.
pub const SHEET: Sheet = Sheet {
    keyword: "preload",
    formulas: &["F constant, along the line between two points or on a joint's coordinate"],
    source: "Newton",
};

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, preload: &Preload) -> Result<(), BuildError> {
    let force = m.formula(g, &preload.value, Context::Motion)?;
    let potential = match preload.on {
        Preloaded::Points(between) => {
            let [a, b] = between.map(|point| m.point(g, point));
            let line = space::sub(g, b.position, a.position);
            let length = space::norm(g, line);
            let density = g.div(force, length);
            let pull = space::scale(g, density, line);
            loads.add_force_pair(g, &b, &a, pull);
            g.mul(force, length)
        }
        Preloaded::Joint(on) => {
            loads.add_joint_effort(g, m, on, force)?;
            let place = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Position);
            let potential = g.mul(force, place);
            g.neg(potential)
        }
    };
    loads.add_potential(g, m, &[force], potential);
    Ok(())
}
