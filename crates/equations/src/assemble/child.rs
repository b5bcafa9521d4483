//! A child's position and motion by the coordinates of its joint; [`super::mobilizers`] for joints of several axes.
//!
//! With F₁, F₂ the joint's frames, A₁, A₂ their rotations in their bodies, u the axis, φ the angle, s the
//! displacement, the second body is rotated by A₁ R(u, φ) A₂ᵀ against the first, and F₂'s origin is u s from that of
//! F₁. Seen from the parent (the first body, or the second with φ and s reversed):
//!
//! ```text
//! R_c = R_p Rᵣ                    ω_c = ω_p + R_c a φ̇
//! r_c = r_p + R_p ρ − R_c f       ρ  = joint in p, with the displacement       f = joint in c       a = axis in c
//! ```

use std::f64::consts::TAU;

use symdiff::Scalar;

use super::mechanism::Mechanism;
use super::tree::InboardJoint;
use crate::assemble::tuning::TUNING;
use crate::elements::joints::Mobilizer;
use crate::grammar::JointCoordinate;
use crate::multibody::{
    ANGLE, Attitude, AxisMotion, Body, BuildError, Context, DegreeOfFreedom, EULER, Matrix, Quaternion, RelativeMotion,
    RotationCoordinates, Vector, rotation,
};

/// The matrix of a rotation that does not change. A quarter turn has zeros and ones, which cost nothing.
pub(super) fn constant_matrix(p: Quaternion<'_>) -> Matrix<'_> {
    let rows = p.matrix().rows().map(|row| {
        row.map(|entry| match entry.as_constant() {
            Some(value) if (value - value.round()).abs() < TUNING.rotation_rounding => {
                entry.builder().number(value.round())
            }
            _ => entry,
        })
    });
    rows.into()
}

/// A rotation against the parent: as Euler parameters, and in the plane as an angle.
pub(super) struct RelativeRotation<'g> {
    /// Euler parameters, in space.
    pub euler: Quaternion<'g>,
    /// Angle, in the plane.
    pub angle: Scalar<'g>,
}

impl<'g> Mechanism<'g, '_> {
    /// Places a child against its parent, which is placed already.
    pub fn place_child(&mut self, body: usize, inboard: InboardJoint) -> Result<(), BuildError> {
        let joints = self.joints;
        // A joint of the tree has a mobilizer; without one a body would be welded.
        let Some(mobilizer) = joints[inboard.joint].kind.mobilizer() else { return Ok(()) };
        let (motion, rotation) = if mobilizer.has_one_axis() {
            self.motion_by_one_axis(&mobilizer, inboard)?
        } else {
            self.motion_by_axes(&mobilizer, inboard)?
        };
        self.set_motion(body, motion, rotation);
        Ok(())
    }

    /// The motion by an angle about an axis and a displacement along it.
    fn motion_by_one_axis(
        &mut self,
        mobilizer: &Mobilizer,
        inboard: InboardJoint,
    ) -> Result<(RelativeMotion<'g>, RelativeRotation<'g>), BuildError> {
        let dofs = self.degrees_of_freedom(mobilizer, inboard)?;
        let g = self.g;
        let total = |list: &[Scalar<'g>], part: fn(&DegreeOfFreedom<'g>) -> Scalar<'g>| {
            g.sum(dofs.iter().map(|dof| part(dof) * list[dof.index]))
        };
        let angle = total(&self.q, |dof| dof.rotation[0]);
        let angular = [total(&self.v, |dof| dof.rotation[0]), total(&self.w, |dof| dof.rotation[0])];
        let displacement = total(&self.q, |dof| dof.translation[0]);
        let sliding = [total(&self.v, |dof| dof.translation[0]), total(&self.w, |dof| dof.translation[0])];

        let axis = match mobilizer.axis() {
            Some(axis) => self.unit_vector(axis, Context::Parameters)?,
            None => Vector::along(g, 2),
        };
        // The second frame may be rotated against the first, about its z; the axis is one of the first.
        let rest = match mobilizer.twist() {
            Some(angle) => self.formula(angle, Context::Parameters)?,
            None => g.number(0.0),
        };
        let twist = Quaternion::about(Vector::along(g, 2), rest);
        let [parent, child] = [inboard.parent, inboard.child].map(|point| self.local_frame(point));
        let (before, after) = if inboard.reversed {
            (parent * twist.conjugate(), child.conjugate())
        } else {
            (parent, twist * child.conjugate())
        };
        let (r_before, r_after) = (constant_matrix(before), constant_matrix(after));
        let relative = r_before * rotation::matrix_about(axis, angle) * r_after;
        let axis_in_parent = r_before * axis;
        let axis_in_child = r_after.transposed() * axis;

        let moved = displacement * axis_in_parent;
        let along = |rates| vec![AxisMotion { in_parent: axis_in_parent, in_child: axis_in_child, rates }];
        let motion = RelativeMotion {
            parent: inboard.parent.body,
            joint: inboard.joint,
            rotation: relative,
            outboard_in_parent: self.local(inboard.parent) + moved,
            outboard_in_child: self.local(inboard.child),
            rotations: along(angular),
            translations: along(sliding),
            gyration: None,
            drift: None,
            dofs,
        };
        let euler = before * Quaternion::about(axis, angle) * after;
        let angle = if inboard.reversed { angle - rest } else { angle + rest };
        Ok((motion, RelativeRotation { euler, angle }))
    }

    /// The coordinates of a joint of the tree; φ and s count from the parent.
    fn degrees_of_freedom(
        &mut self,
        mobilizer: &Mobilizer,
        inboard: InboardJoint,
    ) -> Result<Vec<DegreeOfFreedom<'g>>, BuildError> {
        let g = self.g;
        let (zero, one) = (g.number(0.0), g.number(if inboard.reversed { -1.0 } else { 1.0 }));
        let mut dofs = Vec::new();
        for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
            if !mobilizer.is_counted_by(coordinate) {
                continue;
            }
            let (rotation, translation) = match (mobilizer.pitch(), coordinate) {
                (Some(pitch), _) => {
                    let advance = 1.0 / TAU * self.formula(pitch, Context::Parameters)?;
                    (one, one * advance)
                }
                (None, JointCoordinate::Angle) => (one, zero),
                (None, JointCoordinate::Displacement) => (zero, one),
            };
            let index = self.add_joint_coordinate(inboard.joint, coordinate);
            dofs.push(DegreeOfFreedom { index, rotation: vec![rotation], translation: vec![translation] });
        }
        Ok(dofs)
    }

    /// Position, velocity and acceleration of a child in the ground's axes.
    fn set_motion(&mut self, index: usize, motion: RelativeMotion<'g>, relative: RelativeRotation<'g>) {
        let parent = &self.bodies[motion.parent];
        let mut body = self.bodies[index].clone();
        let arm = parent.rotate(motion.outboard_in_parent);
        let (joint, joint_velocity) = (parent.position_of(arm), parent.velocity_of(arm));
        let joint_acceleration = parent.acceleration_of(arm);
        let omega = parent.angular_velocity();
        match body.rotation_coordinates {
            RotationCoordinates::Angle => {
                body.position[ANGLE] = parent.position[ANGLE] + relative.angle;
                let rate = |derivative: usize| self.g.sum(motion.rotations.iter().map(|axis| axis.rates[derivative]));
                body.velocity[ANGLE] = parent.velocity[ANGLE] + rate(0);
                body.acceleration[ANGLE] = parent.acceleration[ANGLE] + rate(1);
            }
            RotationCoordinates::Euler => set_orientation(&mut body, parent, &motion, relative.euler),
        }

        // The outboard frame moves with the parent and slides; the child's origin follows from it.
        let sliding = |derivative| motion.rates(&motion.translations, derivative, |axis| parent.rotate(axis));
        let slip = sliding(0);
        let joint_velocity = joint_velocity + slip;
        let gain = sliding(1);
        let coriolis = 2.0 * omega.cross(slip);
        let mut joint_acceleration = joint_acceleration + gain + coriolis;
        if let Some(drift) = motion.drift {
            joint_acceleration += parent.rotate(drift);
        }
        let arm = body.rotate(-motion.outboard_in_child);
        set_origin(&mut body, [joint, joint_velocity, joint_acceleration]);
        let origin = [body.position_of(arm), body.velocity_of(arm), body.acceleration_of(arm)];
        set_origin(&mut body, origin);
        body.relative_motion = Some(Box::new(motion));
        self.bodies[index] = body;
    }
}

/// Euler parameters and their derivatives of a child in space.
fn set_orientation<'g>(body: &mut Body<'g>, parent: &Body<'g>, motion: &RelativeMotion<'g>, relative: Quaternion<'g>) {
    let p = parent.orientation() * relative;
    let matrix = parent.matrix() * motion.rotation;
    let omega_of_parent = parent.angular_velocity();
    let turning = |derivative| motion.rates(&motion.rotations, derivative, |axis| parent.rotate(axis));
    let own = turning(0);
    let omega = omega_of_parent + own;
    let alpha_of_parent = parent.angular_acceleration();
    let (gain, gyration) = (turning(1), omega_of_parent.cross(own));
    let mut alpha = alpha_of_parent + gain + gyration;
    if let Some([in_parent, _]) = motion.gyration {
        alpha += parent.rotate(in_parent);
    }
    let rates = p.ground_rates();
    let velocity = rates.transposed_times(0.5, omega);
    let acceleration = rates.transposed_times(0.5, alpha);
    // p̈ = ½ Eᵀ ω̇ − ¼ |ω|² p
    let pull = 0.25 * omega.dot(omega);
    for component in 0..4 {
        body.position[EULER + component] = p[component];
        body.velocity[EULER + component] = velocity[component];
        body.acceleration[EULER + component] = acceleration[component] - pull * p[component];
    }
    body.attitude = Some(Attitude { matrix, omega, alpha });
}

/// Position, velocity and acceleration of a body's origin.
fn set_origin<'g>(body: &mut Body<'g>, [position, velocity, acceleration]: [Vector<'g>; 3]) {
    body.position[..3].copy_from_slice(&position.components());
    body.velocity[..3].copy_from_slice(&velocity.components());
    body.acceleration[..3].copy_from_slice(&acceleration.components());
}
