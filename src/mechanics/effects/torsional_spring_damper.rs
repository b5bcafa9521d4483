//! Torsional spring and damper between two bodies' angles, or on the angle of a joint.
//!
//! ```text
//! τ = k (φ − φ₀) + c φ̇,   φ = θ₂ − θ₁ or the joint's angle,   V = ½ k (φ − φ₀)²          N m, J
//! −τ about the axis on the second body, +τ on the first
//! ```
//!
//! Angles are never wrapped: the spring winds up over many turns. Where k or φ₀ depend on the motion there is no
//! potential and none is counted.

use symdiff::{Formula, Graph};

use crate::mechanics::body::ANGLE;
use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::{Context, Mechanism};
use crate::model::{JointCoordinate, TimeOrder, Twisted};

use super::Loads;

pub fn apply(
    g: &mut Graph,
    m: &Mechanism,
    loads: &mut Loads,
    on: Twisted,
    stiffness: &Formula,
    damping: &Formula,
    free_angle: &Formula,
) -> Result<(), BuildError> {
    let stiffness = m.formula(g, stiffness, Context::Motion)?;
    let damping = m.formula(g, damping, Context::Motion)?;
    let free_angle = m.formula(g, free_angle, Context::Motion)?;
    let (turned, rate) = match on {
        Twisted::Bodies([first, second]) => (
            g.sub(m.bodies[second].position[ANGLE], m.bodies[first].position[ANGLE]),
            g.sub(m.bodies[second].velocity[ANGLE], m.bodies[first].velocity[ANGLE]),
        ),
        Twisted::Joint(joint) => {
            let mut coordinate = |order| m.joint_coordinate(g, joint, JointCoordinate::Angle, order);
            (coordinate(TimeOrder::Position), coordinate(TimeOrder::Velocity))
        }
    };
    let twist = g.sub(turned, free_angle);
    let elastic = g.mul(stiffness, twist);
    let viscous = g.mul(damping, rate);
    let torque = g.add(elastic, viscous);
    match on {
        Twisted::Bodies([first, second]) => {
            let zero = g.constant(0.0);
            loads.add_torque_pair(g, second, first, [zero, zero, torque]);
        }
        Twisted::Joint(joint) => {
            let back = g.neg(torque);
            loads.add_joint_torque(g, m, joint, back)?;
        }
    }
    let square = g.mul(twist, twist);
    let doubled = g.mul(stiffness, square);
    let potential = g.scale(0.5, doubled);
    loads.add_potential(g, m, &[stiffness, free_angle], potential);
    Ok(())
}
