//! What joints constrain, one file each.
//!
//! A joint contributes rows Φ(q, t) = 0. The equations of motion are M w = Q − Φ_qᵀ λ, so a row's generalised force is
//! −Φ_qᵀ λ; each row says what that is on the joint's **second** body, for λ = 1: a force in the ground's axes and a
//! torque about the second point. The first body feels the opposite, at the same place (but for gears, see there).
//!
//! To add a joint: its file here, its variant in [`JointKind`], its line in [`rows`].

mod distance;
mod equation;
mod fixed;
mod gear;
mod pin_in_slot;
mod prismatic;
mod revolute;

use symdiff::{Expr, Graph};

use crate::model::JointKind;

use super::error::BuildError;
use super::mechanism::Mechanism;
use super::plane::{self, Vector};

/// One scalar constraint.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// What tells it from the joint's other rows; empty where there are none.
    pub name: &'static str,
    /// Φ, m or rad.
    pub value: Expr,
    /// Force on the second body for λ = 1, in the ground's axes: a unit vector where Φ = 0, or zero.
    pub force: Vector,
    /// Torque on the second body about the second point for λ = 1.
    pub torque: Expr,
}

/// A joint's reaction on its second body.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// In the ground's axes, N.
    pub force: Vector,
    /// |force|, N; for an `equation` its multiplier.
    pub magnitude: Expr,
    /// About the second point, N m.
    pub torque: Expr,
}

/// A joint's rows.
pub fn rows(g: &mut Graph, m: &Mechanism, kind: &JointKind) -> Result<Vec<Row>, BuildError> {
    match kind {
        JointKind::Revolute { between } => Ok(revolute::rows(g, m, *between)),
        JointKind::Prismatic { between, axis, angle } => prismatic::rows(g, m, *between, axis, angle),
        JointKind::Fixed { between, angle } => fixed::rows(g, m, *between, angle),
        JointKind::PinInSlot { between, axis } => pin_in_slot::rows(g, m, *between, axis),
        JointKind::Distance { between, length } => distance::rows(g, m, *between, length),
        JointKind::Gear { between, ratio, offset } => gear::rows(g, m, *between, ratio, offset),
        JointKind::Equation { left, right } => equation::rows(g, m, left, right),
    }
}

/// The reaction Σ λᵢ (forceᵢ, torqueᵢ) over the rows that were kept.
///
/// A dropped row (both sides held) has no multiplier: how much the ground carries there is not determined by the
/// motion, and it counts as zero.
pub fn reaction(g: &mut Graph, kind: &JointKind, kept: &[(Row, Expr)]) -> Reaction {
    let mut force = plane::zero(g);
    let mut torque = g.constant(0.0);
    let mut along = Vec::new();
    for (row, lambda) in kept {
        let part = plane::scale(g, *lambda, row.force);
        force = plane::add(g, force, part);
        let part = g.mul(*lambda, row.torque);
        torque = g.add(torque, part);
        if !row.force.iter().all(|&component| g.is_zero(component)) {
            along.push(*lambda);
        }
    }
    let magnitude = match (kind, kept, along.as_slice()) {
        (JointKind::Equation { .. }, [(_, lambda)], _) => *lambda,
        // One unit vector: no root is needed, which would have no derivative where the force vanishes.
        (_, _, [lambda]) => g.unary(symdiff::Unary::Abs, *lambda),
        _ => {
            let square = plane::dot(g, force, force);
            g.sqrt(square)
        }
    };
    Reaction { force, magnitude, torque }
}
