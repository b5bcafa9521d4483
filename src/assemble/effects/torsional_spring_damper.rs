//! Torsional spring and damper between two bodies' angles, or on the angle of a joint.
//!
//! ```text
//! τ = k (φ − φ₀) + c φ̇,   φ = θ₂ − θ₁ or the joint's angle,   V = ½ k (φ − φ₀)²          N m, J
//! −τ about the axis on the second body, +τ on the first
//! ```
//!
//! Angles are never wrapped: the spring winds up over many turns. A further torque is a formula of the spring's own angle φ
//! and rate. With one, or where k or φ₀ depend on the motion, there is no potential and none is counted.

use symdiff::{Builder, Formula};

use crate::assemble::body::ANGLE;
use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{JointCoordinate, Measure, TimeOrder, TorsionalSpringDamper};

use super::Loads;

pub fn apply(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    spring: &TorsionalSpringDamper,
    [stiffness, damping, free_angle]: [&Formula; 3],
    further: Option<&Formula>,
) -> Result<(), BuildError> {
    let stiffness = m.formula(g, stiffness, Context::Motion)?;
    let damping = m.formula(g, damping, Context::Motion)?;
    let free_angle = m.formula(g, free_angle, Context::Motion)?;
    let bodies = spring.between.map(|bodies| bodies.map(|body| body.0));
    let (turned, rate) = match (bodies, spring.on) {
        (Some([first, second]), None) => (
            g.sub(m.bodies[second].position[ANGLE], m.bodies[first].position[ANGLE]),
            g.sub(m.bodies[second].velocity[ANGLE], m.bodies[first].velocity[ANGLE]),
        ),
        (_, Some(joint)) => {
            let joint = joint.0;
            let coordinate = |order| m.joint_coordinate(g, joint, JointCoordinate::Angle, order);
            (coordinate(TimeOrder::Position), coordinate(TimeOrder::Velocity))
        }
        (None, None) => return Ok(()),
    };
    let twist = g.sub(turned, free_angle);
    let elastic = g.mul(stiffness, twist);
    let viscous = g.mul(damping, rate);
    let mut torque = g.add(elastic, viscous);
    if let Some(further) = further {
        let further = m.own_formula(g, further, &[(Measure::Angle, turned), (Measure::Rate, rate)])?;
        torque = g.add(torque, further);
    }
    for (measure, value) in [(Measure::Angle, turned), (Measure::Rate, rate), (Measure::Torque, torque)] {
        loads.measure(measure, value);
    }
    match (bodies, spring.on) {
        (Some([first, second]), None) => {
            let zero = g.constant(0.0);
            loads.add_torque_pair(g, second, first, [zero, zero, torque]);
        }
        (_, Some(joint)) => {
            let back = g.neg(torque);
            loads.add_joint_torque(g, m, joint.0, back)?;
        }
        (None, None) => {}
    }
    let square = g.mul(twist, twist);
    let doubled = g.mul(stiffness, square);
    let potential = g.scale(0.5, doubled);
    if further.is_none() {
        loads.add_potential(g, m, &[stiffness, free_angle], potential);
    }
    Ok(())
}
