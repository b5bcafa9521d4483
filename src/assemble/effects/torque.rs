//! Torque on a body, or at a joint.
//!
//! ```text
//! τ(on) = +value, or R value where given in the body's axes,   τ(from) = −τ(on)          N m
//! at a joint:   τ = value a₁ on its second body, −τ on its first, a₁ the joint's axis
//! ```
//!
//! In the plane value is about z, counter-clockwise. A motor between two bodies; from the ground, the reaction is the
//! ground's. It has no potential.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};

use super::Loads;

pub fn apply(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    on: usize,
    from: usize,
    value: &[Formula; 3],
    in_body: bool,
) -> Result<(), BuildError> {
    let mut torque = m.vector(g, value, Context::Motion)?;
    if in_body {
        torque = m.bodies[on].rotate(g, torque);
    }
    loads.add_torque_pair(g, from, on, torque);
    Ok(())
}

/// The torque of a motor at a joint.
pub fn apply_at_joint(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    joint: usize,
    value: &Formula,
) -> Result<(), BuildError> {
    let torque = m.formula(g, value, Context::Motion)?;
    loads.add_joint_torque(g, m, joint, torque)
}
