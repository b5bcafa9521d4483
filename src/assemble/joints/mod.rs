//! What joints constrain, one file each.
//!
//! A joint contributes rows Φ(q, t) = 0. The equations of motion are M w = Q − Φ_qᵀ λ, so a row's generalised force is
//! −Φ_qᵀ λ; each row says what that is on the joint's **second** body, for λ = 1: a force in the ground's axes and a
//! torque about the second point. The first body feels the opposite, at the same place (but for gears, see there).
//!
//! To add a joint: its file here, its variant in [`JointKind`], its line in [`rows`].

mod cylindrical;
mod distance;
mod equation;
mod fixed;
mod gear;
mod motor;
mod pair;
mod pin_in_slot;
mod planar;
mod point_on_line;
mod point_on_plane;
mod prismatic;
mod rack;
mod revolute;
mod screw;
mod spherical;
mod universal;

use symdiff::{Builder, Expr, Formula};

use crate::model::{JointCoordinate, JointKind};

use super::error::BuildError;
use super::mechanism::{Context, Mechanism};
use super::space::{self, Vector};

pub use pair::Pair;

/// One scalar constraint.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// What tells it from the joint's other rows; empty where there are none.
    pub name: &'static str,
    /// Φ, m or rad.
    pub value: Expr,
    /// Force on the second body for λ = 1, in the ground's axes: a unit vector where Φ = 0, or zero.
    pub force: Vector,
    /// Torque on the second body about the second point for λ = 1, in the ground's axes.
    pub torque: Vector,
}

/// A joint's reaction on its second body, in the ground's axes.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// N
    pub force: Vector,
    /// |force|, N; for an `equation` its multiplier.
    pub magnitude: Expr,
    /// About the second point, N m.
    pub torque: Vector,
}

/// A joint's rows.
pub fn rows(g: &Builder, m: &Mechanism, joint: usize) -> Result<Vec<Row>, BuildError> {
    match &m.description.joints[joint].kind {
        JointKind::Revolute(it) => revolute::rows(g, m, it.between, &it.axis),
        JointKind::Prismatic(it) => prismatic::rows(g, m, it.between, &it.axis, &it.angle),
        JointKind::Fixed(it) => fixed::rows(g, m, it.between, &it.angle),
        JointKind::PinInSlot(it) => pin_in_slot::rows(g, m, it.between, &it.axis),
        JointKind::Cylindrical(it) => cylindrical::rows(g, m, it.between, &it.axis),
        JointKind::Screw(it) => screw::rows(g, m, joint, it.between, &it.axis, &it.pitch),
        JointKind::Spherical(it) => Ok(spherical::rows(g, m, it.between)),
        JointKind::Universal(it) => universal::rows(g, m, it.between, &it.axes),
        JointKind::Planar(it) => planar::rows(g, m, it.between, &it.normal),
        JointKind::PointOnLine(it) => point_on_line::rows(g, m, it.between, &it.axis),
        JointKind::PointOnPlane(it) => point_on_plane::rows(g, m, it.between, &it.normal),
        JointKind::Distance(it) => distance::rows(g, m, it.between, &it.length),
        JointKind::Gear(it) => gear::rows(g, m, it.between, &it.ratio, &it.offset),
        JointKind::Rack(it) => rack::rows(g, m, [it.pinion, it.rack], &it.radius, &it.offset),
        JointKind::Motor(it) => motor::rows(g, m, it.joint, it.coordinate, &it.motion),
        JointKind::Equation(it) => equation::rows(g, m, &it.left, &it.right),
    }
}

/// A direction of a joint's frames, of length 1.
fn unit_vector(g: &Builder, m: &Mechanism, direction: &[Formula; 3]) -> Result<Vector, BuildError> {
    let direction = m.vector(g, direction, Context::Time)?;
    Ok(space::unit(g, direction))
}

/// The unit vector about (along) which a joint's coordinate is counted, in the ground's axes; zero where it has none.
pub fn axis_in_ground(
    g: &Builder,
    m: &Mechanism,
    joint: usize,
    coordinate: JointCoordinate,
) -> Result<Vector, BuildError> {
    let kind = &m.description.joints[joint].kind;
    let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(coordinate)) else { return Ok(space::zero(g)) };
    let axis = unit_vector(g, m, axis)?;
    Ok(Pair::of(g, m, between).outward(g, axis))
}

/// The reaction Σ λᵢ (forceᵢ, torqueᵢ) over the rows that were kept.
///
/// A dropped row (both sides held) has no multiplier: how much the ground carries there is not determined by the
/// motion, and it counts as zero.
pub fn reaction(g: &Builder, kind: &JointKind, kept: &[(Row, Expr)]) -> Reaction {
    let (mut force, mut torque) = (space::zero(g), space::zero(g));
    let mut along = Vec::new();
    for (row, lambda) in kept {
        let part = space::scale(g, *lambda, row.force);
        force = space::add(g, force, part);
        let part = space::scale(g, *lambda, row.torque);
        torque = space::add(g, torque, part);
        if !row.force.iter().all(|&component| g.is_zero(component)) {
            along.push(*lambda);
        }
    }
    let magnitude = match (kind.equation(), kept, along.as_slice()) {
        (Some(_), [(_, lambda)], _) => *lambda,
        // One unit vector: no root is needed, which would have no derivative where the force vanishes.
        (_, _, [lambda]) => g.unary(symdiff::Unary::Abs, *lambda),
        _ => space::norm(g, force),
    };
    Reaction { force, magnitude, torque }
}
