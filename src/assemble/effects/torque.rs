//! Torque on a body, or at a joint.
//!
//! ```text
//! τ(on) = +value, or R value where given in the body's axes,   τ(from) = −τ(on)          N m
//! at a joint:   τ = value a₁ on its second body, −τ on its first, a₁ the joint's axis
//! ```
//!
//! In the plane value is about z, counter-clockwise. A motor between two bodies; from the ground, the reaction is the
//! ground's. It has no potential.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::Torque;
use crate::model::force::Frame;
use crate::model::torque::TorqueOn;

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, effect: &Torque) -> Result<(), BuildError> {
    match effect.on {
        TorqueOn::Body(on) => {
            let mut torque = m.vector(g, &effect.value.0, Context::Motion)?;
            if effect.frame == Frame::Body {
                torque = m.bodies[on].rotate(g, torque);
            }
            loads.add_torque_pair(g, effect.reaction_on(), on, torque);
            Ok(())
        }
        TorqueOn::Joint(joint) => {
            let torque = m.formula(g, &effect.value.0[2], Context::Motion)?;
            loads.add_joint_torque(g, m, joint, torque)
        }
    }
}
