//! Friction in a revolute, prismatic or cylindrical joint, proportional to the joint's own reaction.
//!
//! ```text
//! load            N = |F_λ|, or |F₊| + |F₋| with F± = F_λ/2 ± (M_λ × a)/L in a bearing of length L          N
//! turning         τ = −[(C + μ r N) R(ω) + c] ω             N m, about the axis on the second body
//! sliding         f = −[(C + μ N) R(ṡ) + c] ṡ               N, along the axis
//! both            f = −[(C + μ N) R(u) + c] ṡ,   τ = −[(C + μ N) R(u) + c] r² ω,   u = (ṡ, r ω)
//! ```
//!
//! F_λ, M_λ are the joint's reaction on the second body, a its axis, R that of `dry_friction`, C a part of the dry friction
//! that has nothing to do with the load, c viscous. The opposites act on the first body. Q so depends on λ, and the Newton
//! matrix has its block −∂Q/∂λ. |F| is √(F² + ε²), ε = 1 µN, for |F| has no slope at 0. Where friction is so large that the
//! reaction it needs grows faster than what it resists, the mechanism jams (Painlevé) and there is no motion to be found.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::joints;
use crate::assemble::mechanism::Mechanism;
use crate::model::{FrictionMode, JointCoordinate, JointFriction, Measure, OnJoint};
use crate::multibody::Vector;

use super::Loads;
use super::dry_friction::DryFriction;

/// ε, N
const NO_LOAD: f64 = 1e-6;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, friction: &JointFriction) -> Result<(), BuildError> {
    let joint = friction.on.joint;
    let dry = DryFriction::of(g, m, &friction.coefficient, &friction.dry)?;
    let constant = m.value(g, &friction.coulomb)?;
    let viscous = m.value(g, &friction.viscous)?;
    let radius = match &friction.radius {
        Some(radius) => m.value(g, radius)?,
        None => g.number(0.0),
    };
    let load = load(g, m, friction)?;
    let mut bound = dry.coefficient * load;
    if friction.on.mode == FrictionMode::Turning {
        bound = radius * bound;
    }
    let bound = constant + bound;

    let rate = |coordinate| m.joint_rate(g, joint, coordinate).map(|rate| g.scalar(rate));
    let velocity = match friction.on.mode {
        FrictionMode::Turning => vec![rate(JointCoordinate::Angle)?],
        FrictionMode::Sliding => vec![rate(JointCoordinate::Displacement)?],
        FrictionMode::Both => {
            let turning = rate(JointCoordinate::Angle)?;
            vec![rate(JointCoordinate::Displacement)?, radius * turning]
        }
    };
    let square = velocity.iter().fold(g.number(0.0), |sum, &velocity| sum + velocity * velocity);
    let resistance = bound * dry.resistance(square) + viscous;
    let against: Vec<Scalar> = velocity.iter().map(|&velocity| -(resistance * velocity)).collect();
    let efforts = match friction.on.mode {
        FrictionMode::Turning => vec![(JointCoordinate::Angle, against[0])],
        FrictionMode::Sliding => vec![(JointCoordinate::Displacement, against[0])],
        FrictionMode::Both => {
            vec![(JointCoordinate::Displacement, against[0]), (JointCoordinate::Angle, radius * against[1])]
        }
    };
    loads.measure(Measure::LOAD, load.expr());
    for (coordinate, effort) in efforts {
        loads.add_joint_effort(g, m, OnJoint { joint, coordinate }, effort.expr())?;
        loads.measure(Measure::of_effort(coordinate), effort.expr());
    }
    Ok(())
}

/// N.
fn load<'g>(g: &'g Builder, m: &Mechanism, friction: &JointFriction) -> Result<Scalar<'g>, BuildError> {
    let reaction = &m.reactions[friction.on.joint];
    let (force, torque) = (Vector::of(g, reaction.force), Vector::of(g, reaction.torque));
    let Some(length) = &friction.length else { return Ok(magnitude(force)) };
    let length = m.value(g, length)?;
    let coordinate = match friction.on.mode {
        FrictionMode::Turning => JointCoordinate::Angle,
        FrictionMode::Sliding | FrictionMode::Both => JointCoordinate::Displacement,
    };
    let axis = Vector::of(g, joints::axis_in_ground(g, m, friction.on.joint, coordinate)?);
    let couple = torque.cross(axis) / length;
    let half = 0.5 * force;
    Ok(magnitude(half + couple) + magnitude(half - couple))
}

/// √(F² + ε²).
fn magnitude(force: Vector<'_>) -> Scalar<'_> {
    (force.dot(force) + NO_LOAD * NO_LOAD).sqrt()
}
