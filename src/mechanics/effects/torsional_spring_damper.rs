//! Torsional spring and damper between two bodies' angles.
//!
//! ```text
//! τ = k (φ − φ₀) + c φ̇,   φ = θ₂ − θ₁,   V = ½ k (φ − φ₀)²          N m, J
//! Q_θ₂ = −τ,   Q_θ₁ = +τ
//! ```
//!
//! Angles are never wrapped: the spring winds up over many turns. Where k or φ₀ depend on the motion there is no
//! potential and none is counted.

use symdiff::{Formula, Graph};

use crate::mechanics::body::ANGLE;
use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::{Context, Mechanism};

use super::Loads;

pub fn apply(
    g: &mut Graph,
    m: &Mechanism,
    loads: &mut Loads,
    [first, second]: [usize; 2],
    stiffness: &Formula,
    damping: &Formula,
    free_angle: &Formula,
) -> Result<(), BuildError> {
    let stiffness = m.formula(g, stiffness, Context::Motion)?;
    let damping = m.formula(g, damping, Context::Motion)?;
    let free_angle = m.formula(g, free_angle, Context::Motion)?;
    let turned = g.sub(m.bodies[second].position[ANGLE], m.bodies[first].position[ANGLE]);
    let rate = g.sub(m.bodies[second].velocity[ANGLE], m.bodies[first].velocity[ANGLE]);
    let twist = g.sub(turned, free_angle);
    let elastic = g.mul(stiffness, twist);
    let viscous = g.mul(damping, rate);
    let torque = g.add(elastic, viscous);
    loads.add_torque_pair(g, second, first, torque);
    let square = g.mul(twist, twist);
    let doubled = g.mul(stiffness, square);
    let potential = g.scale(0.5, doubled);
    loads.add_potential(g, m, &[stiffness, free_angle], potential);
    Ok(())
}
