//! Reactions of joints.

use symdiff::{Builder, Scalar};

use crate::elements::joints::{Joint, Row, ToothForce};
use crate::multibody::Vector;

/// A joint's reaction on its second body, in the ground's axes.
#[derive(Clone, Copy, Debug)]
pub struct Reaction<'g> {
    /// N
    pub force: Vector<'g>,
    /// |force|, N; for an `equation` its multiplier.
    pub magnitude: Scalar<'g>,
    /// Torque about the second point, N m.
    pub torque: Vector<'g>,
    /// Torque about the joint's axis, N m, if there is no other torque and no force: of a motor and a gear.
    pub about_axis: Option<Scalar<'g>>,
    /// Force along a line that moves against both bodies, N: the tension of a rod.
    pub along_line: Option<Scalar<'g>>,
}

impl<'g> Reaction<'g> {
    /// Σ λᵢ (forceᵢ, torqueᵢ) over the rows `kept`, each with its multiplier.
    ///
    /// A dropped row (both sides prescribed) has no multiplier: how much the ground takes up there is not determined by
    /// the motion, and it counts as zero.
    pub fn of(g: &'g Builder, joint: &dyn Joint, kept: &[(Row<'g>, Scalar<'g>)]) -> Self {
        let (mut force, mut torque) = (Vector::zero(g), Vector::zero(g));
        let mut along = Vec::new();
        for &(row, lambda) in kept {
            force += lambda * row.force;
            torque += lambda * row.torque;
            if !row.force.is_zero() {
                along.push(lambda);
            }
        }
        let magnitude = match (joint.equation(), kept, along.as_slice()) {
            (Some(_), &[(_, lambda)], _) => lambda,
            // One unit vector: no root is needed, which would have no derivative where the force vanishes.
            (_, _, [lambda]) => lambda.abs(),
            _ => force.norm(),
        };
        // A coupling's row pushes against its coordinate: its vector is the opposite of the axis.
        let about_axis = match kept {
            &[(row, lambda)] if row.force.is_zero() && !row.torque.is_zero() && joint.between().is_none() => {
                Some(-lambda)
            }
            _ => None,
        };
        let along_line = match (joint.axial_by_multiplier(), kept) {
            (Some(sign), &[(_, lambda)]) => Some(sign * lambda),
            _ => None,
        };
        Self { force, magnitude, torque, about_axis, along_line }
    }

    /// The same of a joint with teeth: its force is that on the second body at the pitch point.
    pub fn with_teeth(self, tooth: &ToothForce<'g>) -> Self {
        Self { force: tooth.force, magnitude: tooth.magnitude, ..self }
    }
}
