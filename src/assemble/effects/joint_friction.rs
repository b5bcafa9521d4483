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

use symdiff::{Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::joints;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space::{self, Vector};
use crate::model::{FrictionMode, JointCoordinate, JointFriction, Measure};

use super::Loads;
use super::dry_friction::DryFriction;

/// ε, N
const NO_LOAD: f64 = 1e-6;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, friction: &JointFriction) -> Result<(), BuildError> {
    let joint = friction.on.joint;
    let dry = DryFriction::of(g, m, &friction.coefficient, &friction.dry)?;
    let constant = m.formula(g, &friction.coulomb, Context::Motion)?;
    let viscous = m.formula(g, &friction.viscous, Context::Motion)?;
    let radius = match &friction.radius {
        Some(radius) => m.formula(g, radius, Context::Motion)?,
        None => g.constant(0.0),
    };
    let load = load(g, m, friction)?;
    let mut bound = g.mul(dry.coefficient, load);
    if friction.on.mode == FrictionMode::Turning {
        bound = g.mul(radius, bound);
    }
    let bound = g.add(constant, bound);

    let rate = |g: &Builder, coordinate| m.joint_rate(g, joint, coordinate);
    let mut efforts = Vec::new();
    let velocity = match friction.on.mode {
        FrictionMode::Turning => vec![rate(g, JointCoordinate::Angle)?],
        FrictionMode::Sliding => vec![rate(g, JointCoordinate::Displacement)?],
        FrictionMode::Both => {
            let turning = rate(g, JointCoordinate::Angle)?;
            vec![rate(g, JointCoordinate::Displacement)?, g.mul(radius, turning)]
        }
    };
    let resistance = dry.resistance(g, &velocity);
    let resistance = g.mul(bound, resistance);
    let resistance = g.add(resistance, viscous);
    let against = velocity.iter().map(|&velocity| {
        let drag = g.mul(resistance, velocity);
        g.neg(drag)
    });
    let against: Vec<Expr> = against.collect();
    match friction.on.mode {
        FrictionMode::Turning => efforts.push((JointCoordinate::Angle, against[0])),
        FrictionMode::Sliding => efforts.push((JointCoordinate::Displacement, against[0])),
        FrictionMode::Both => {
            efforts.push((JointCoordinate::Displacement, against[0]));
            efforts.push((JointCoordinate::Angle, g.mul(radius, against[1])));
        }
    }
    loads.measure(Measure::Load, load);
    for (coordinate, effort) in efforts {
        match coordinate {
            JointCoordinate::Angle => loads.add_joint_torque(g, m, joint, effort)?,
            JointCoordinate::Displacement => loads.add_joint_force(g, m, joint, effort)?,
        }
        loads.measure(Measure::of_effort(coordinate), effort);
    }
    Ok(())
}

/// N.
fn load(g: &Builder, m: &Mechanism, friction: &JointFriction) -> Result<Expr, BuildError> {
    let reaction = &m.reactions[friction.on.joint];
    let (force, torque) = (reaction.force, reaction.torque);
    let Some(length) = &friction.length else { return Ok(magnitude(g, force)) };
    let length = m.formula(g, length, Context::Motion)?;
    let coordinate = match friction.on.mode {
        FrictionMode::Turning => JointCoordinate::Angle,
        FrictionMode::Sliding | FrictionMode::Both => JointCoordinate::Displacement,
    };
    let axis = joints::axis_in_ground(g, m, friction.on.joint, coordinate)?;
    let couple = space::cross(g, torque, axis);
    let couple = couple.map(|component| g.div(component, length));
    let half = force.map(|component| g.scale(0.5, component));
    let (front, back) = (space::add(g, half, couple), space::sub(g, half, couple));
    let (front, back) = (magnitude(g, front), magnitude(g, back));
    Ok(g.add(front, back))
}

/// √(F² + ε²).
fn magnitude(g: &Builder, force: Vector) -> Expr {
    let square = space::dot(g, force, force);
    let least = g.constant(NO_LOAD * NO_LOAD);
    let sum = g.add(square, least);
    g.sqrt(sum)
}
