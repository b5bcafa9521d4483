//! Torsional spring and damper between two bodies' angles, or on the angle of a joint.
//!
//! ```text
//! τ = k (φ − φ₀) + c φ̇,   φ = θ₂ − θ₁ or the joint's angle,   V = ½ k (φ − φ₀)²          N m, J
//! −τ about the axis on the second body, +τ on the first
//! ```
//!
//! Angles are never wrapped: the spring winds up over many turns. A further torque is a formula of the spring's own angle φ
//! and rate. With one, or where k or φ₀ depend on the motion, there is no potential and none is counted.

use symdiff::Builder;

use crate::assemble::body::ANGLE;
use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{JointCoordinate, Measure, OnJoint, TorsionalSpringDamper};

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, spring: &TorsionalSpringDamper) -> Result<(), BuildError> {
    let stiffness = m.value(g, &spring.stiffness)?;
    let damping = m.value(g, &spring.damping)?;
    let free_angle = m.value(g, &spring.free_angle)?;
    let bodies = spring.between.map(|bodies| bodies.map(|body| body.0));
    let [angle, rate] = match (bodies, spring.on) {
        (Some([first, second]), None) => {
            let [first, second] = [first, second].map(|body| &m.bodies[body]);
            let difference = |after, before| g.scalar(after) - g.scalar(before);
            [
                difference(second.position[ANGLE], first.position[ANGLE]),
                difference(second.velocity[ANGLE], first.velocity[ANGLE]),
            ]
        }
        (_, Some(joint)) => m.coordinate_and_rate(g, OnJoint { joint: joint.0, coordinate: JointCoordinate::Angle }),
        (None, None) => return Ok(()),
    };
    let twist = angle - free_angle;
    let mut torque = stiffness * twist + damping * rate;
    if let Some(further) = &spring.torque {
        let own = [(Measure::ANGLE, angle.expr()), (Measure::RATE, rate.expr())];
        torque += g.scalar(m.own_formula(g, further, &own)?);
    }
    for (measure, value) in [(Measure::ANGLE, angle), (Measure::RATE, rate), (Measure::TORQUE, torque)] {
        loads.measure(measure, value.expr());
    }
    match (bodies, spring.on) {
        (Some([first, second]), None) => {
            let zero = g.constant(0.0);
            loads.add_torque_pair(g, second, first, [zero, zero, torque.expr()]);
        }
        (_, Some(joint)) => loads.add_joint_torque(g, m, joint.0, (-torque).expr())?,
        (None, None) => {}
    }
    let potential = 0.5 * (stiffness * (twist * twist));
    if spring.torque.is_none() {
        loads.add_potential(g, m, &[stiffness.expr(), free_angle.expr()], potential.expr());
    }
    Ok(())
}
