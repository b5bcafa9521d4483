//! Newton–Euler recursion: the inertial forces of children, as generalised forces.
//!
//! In each body's own axes, with ω, ω̇ and the acceleration a of its origin, outwards from a root
//!
//! ```text
//! U = ω̇̃ + ω̃ ω̃          ω_c = Rᵣᵀ ω_p + Ω          ω̇_c = Rᵣᵀ ω̇_p + Ω̇ + (Rᵣᵀ ω_p) × Ω
//! a_c = Rᵣᵀ (a_p + U_p ρ + 2 ω_p × ρ̇ + ρ̈) − U_c f
//! ```
//!
//! with the relative motion Ω = Σ u φ̇, ρ̇ = Σ e ṡ of the joint ([`crate::multibody::RelativeMotion`]), and back, m s
//! being the body's first and Σ = ½ tr J₀ 1 − J₀ its second moment of mass about the origin,
//!
//! ```text
//! F = m a + U m s          N = m s × a + 2 ax(U Σ)          ax(A) = ½ (A₃₂ − A₂₃, A₁₃ − A₃₁, A₂₁ − A₁₂)
//! φ: u · (N − f × F),   s: u · F          onto the parent: Rᵣ F,   Rᵣ (N − f × F) + ρ × Rᵣ F
//! ```
//!
//! A uniform field of acceleration g enters as −g on the roots, so that weights need no terms of their own. (Luh,
//! Walker & Paul, J. Dyn. Syst. Meas. Control 102 (1980) 69; with U, Khalil & Dombre, *Modeling, Identification and
//! Control of Robots*, ch. 9.) The generalised forces are linear in w; their Jacobian is the mass matrix.

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::reaction::Reaction;
use crate::elements::joints::Mobilizer;
use crate::grammar::JointCoordinate;
use crate::multibody::{Body, Matrix, Quaternion, RelativeMotion, RotationCoordinates, Vector, Wrench};

/// Coordinates of a joint that turns by them; no other joint has as many.
const EULER_PARAMETERS: usize = 4;

/// Motion of a body's frame, in its own axes.
#[derive(Clone, Copy)]
struct Motion<'g> {
    omega: Vector<'g>,
    alpha: Vector<'g>,
    acceleration: Vector<'g>,
    /// U.
    spread: Matrix<'g>,
}

impl<'g> Motion<'g> {
    fn new(omega: Vector<'g>, alpha: Vector<'g>, acceleration: Vector<'g>) -> Self {
        Self { omega, alpha, acceleration, spread: spread(omega, alpha) }
    }

    /// The motion of a root by its own coordinates, in a field of acceleration.
    fn of_root(body: &Body<'g>, field: Vector<'g>) -> Self {
        let felt = body.acceleration_of_origin() - field;
        let acceleration = body.matrix().transposed() * felt;
        let (omega, alpha) = (body.angular_velocity_in_body(), body.angular_acceleration_in_body());
        Self::new(omega, alpha, acceleration)
    }

    fn of_child(motion: &RelativeMotion<'g>, parent: &Self) -> Self {
        let back = motion.rotation.transposed();
        let (inherited, own) = (back * parent.omega, motion.turning(0));
        let omega = inherited + own;
        let gyration = inherited.cross(own);
        let mut alpha = back * parent.alpha + motion.turning(1) + gyration;
        if let Some([_, in_child]) = motion.gyration {
            alpha += in_child;
        }

        let rotational = parent.acceleration + parent.spread * motion.outboard_in_parent;
        let slip = motion.sliding(0);
        let coriolis = 2.0 * parent.omega.cross(slip);
        let mut at_joint = rotational + coriolis + motion.sliding(1);
        if let Some(drift) = motion.drift {
            at_joint += drift;
        }
        let at_joint = Self::new(omega, alpha, back * at_joint);
        let acceleration = at_joint.acceleration - at_joint.spread * motion.outboard_in_child;
        Self { acceleration, ..at_joint }
    }
}

/// Inertial forces of the bodies of the trees.
pub struct InertialForces<'g> {
    /// Force on each coordinate, n.
    pub generalised: Vec<Scalar<'g>>,
    /// Wrench on each body, of it and all its children, and of theirs, in its own axes; zero for a root without any.
    pub wrenches: Vec<Wrench<'g>>,
    /// ω, ω̇ and the acceleration of the origin in the body's own axes, by body; empty if no child follows from it.
    pub motions: Vec<Vec<Scalar<'g>>>,
}

/// The inertial forces of all children, less their weight in a uniform field of acceleration (m/s², in the ground's
/// axes).
pub fn inertial_forces<'g>(m: &Mechanism<'g, '_>, field: Vector<'g>) -> InertialForces<'g> {
    let g = m.g;
    let mut forces = InertialForces {
        generalised: vec![g.number(0.0); m.q.len()],
        wrenches: vec![Wrench::zero(g); m.bodies.len()],
        motions: vec![Vec::new(); m.bodies.len()],
    };
    let mut motions: Vec<Option<Motion>> = vec![None; m.bodies.len()];
    for &index in &m.tree.order {
        let body = &m.bodies[index];
        let Some(relative) = &body.relative_motion else { continue };
        let parent = relative.parent;
        let parent = *motions[parent].get_or_insert_with(|| Motion::of_root(&m.bodies[parent], field));
        let motion = Motion::of_child(relative, &parent);
        forces.wrenches[index] = inertial_wrench(body, &motion);
        motions[index] = Some(motion);
    }
    for &index in m.tree.order.iter().rev() {
        let Some(relative) = &m.bodies[index].relative_motion else { continue };
        let wrench = forces.wrenches[index];
        let at_joint = wrench.torque_about(relative.outboard_in_child);
        let about = relative.rotations.iter().map(|axis| axis.in_child.dot(at_joint)).collect();
        let along = relative.translations.iter().map(|axis| axis.in_child.dot(wrench.force)).collect();
        for (row, part) in relative.generalised(about, along) {
            forces.generalised[row] = part;
        }
        if relative.dofs.len() == EULER_PARAMETERS {
            add_along_euler(m, &m.bodies[index], relative, &mut forces.generalised);
        }
        let force = relative.rotation * wrench.force;
        let torque = relative.rotation * at_joint + relative.outboard_in_parent.cross(force);
        forces.wrenches[relative.parent] += Wrench { force, torque };
    }
    for (body, &wrench) in m.bodies.iter().zip(&forces.wrenches) {
        add_on_root(body, wrench, &mut forces.generalised);
    }
    for (values, motion) in forces.motions.iter_mut().zip(&motions) {
        let vectors = motion.iter().flat_map(|motion| [motion.omega, motion.alpha, motion.acceleration]);
        *values = vectors.flat_map(Vector::components).collect();
    }
    forces
}

/// U = ω̇̃ + ω̃ ω̃.
fn spread<'g>(omega: Vector<'g>, alpha: Vector<'g>) -> Matrix<'g> {
    let squares = omega.map(|component| component * component);
    Matrix::from_fn(|i, j| {
        if i == j {
            return -(squares[(i + 1) % 3] + squares[(i + 2) % 3]);
        }
        let product = omega[i] * omega[j];
        let other = alpha[3 - i - j];
        if (i + 1) % 3 == j { product - other } else { product + other }
    })
}

/// F and N of the body alone.
fn inertial_wrench<'g>(body: &Body<'g>, motion: &Motion<'g>) -> Wrench<'g> {
    let first = body.mass * body.center;
    let force = body.mass * motion.acceleration + motion.spread * first;

    let inertia = body.inertia_about_origin();
    let half = 0.5 * inertia.trace();
    let second = Matrix::from_fn(|i, j| if i == j { half - inertia[i][j] } else { -inertia[i][j] });
    let rotational = match body.rotation_coordinates {
        // Only the inertia about z is known, and the body turns about no other axis.
        RotationCoordinates::Angle => {
            let zero = body.mass.builder().number(0.0);
            [zero, zero, inertia[2][2] * motion.alpha[2]]
        }
        RotationCoordinates::Euler => {
            let product = motion.spread * second;
            std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                product[k][j] - product[j][k]
            })
        }
    };
    Wrench { force, torque: first.cross(motion.acceleration) + Vector::from(rotational) }
}

/// 4 μ r rᵀ r̈ on Euler parameters r of a joint, μ a third of the trace of the inertia about it: M knows nothing else
/// of a change of
/// |r|. It changes no motion, since the multiplier of rᵀr = 1 takes it up.
fn add_along_euler<'g>(
    m: &Mechanism<'g, '_>,
    body: &Body<'g>,
    relative: &RelativeMotion<'g>,
    generalised: &mut [Scalar<'g>],
) {
    let arm = body.center - relative.outboard_in_child;
    let inertia = body.inertia.trace() + 2.0 * (body.mass * arm.dot(arm));
    let [r, second_derivative]: [Quaternion; 2] =
        [&m.q, &m.w].map(|list| std::array::from_fn(|index| list[relative.dofs[index].index]).into());
    let along = (4.0 / 3.0 * inertia) * r.dot(second_derivative);
    for (dof, &component) in relative.dofs.iter().zip(&r.components()) {
        generalised[dof.index] += along * component;
    }
}

/// Adds the inertial forces of a root's children to its own coordinates.
fn add_on_root<'g>(body: &Body<'g>, Wrench { force, torque }: Wrench<'g>, generalised: &mut [Scalar<'g>]) {
    if body.has_no_coordinates() {
        return;
    }
    let parts = body.generalised_of_torque_in_body(body.rotate(force), torque);
    for (index, part) in body.index.iter().zip(parts) {
        if let Some(row) = *index {
            generalised[row] += part;
        }
    }
}

impl<'g> Mechanism<'g, '_> {
    /// Adds the reactions of the joints of the trees, in the ground's axes: the force that moves a body and all its
    /// children, less the forces on them and the reactions of the joints `closures`, which are constraints. Along its
    /// own coordinates a joint has none.
    pub fn add_reactions_of_trees(
        &mut self,
        applied: AppliedForces<'g>,
        forces: &InertialForces<'g>,
        closures: &[usize],
    ) {
        let mut applied = applied;
        for &joint in closures {
            let Reaction { force, torque, .. } = self.reactions[joint];
            let Some([first, second]) = self.joints[joint].kind.between() else { continue };
            let place = self.point(second);
            applied.add_force(&place, force);
            applied.add_force(&self.point_now_at(first.body, place.position), -force);
            applied.add_torque_pair(first.body, second.body, torque);
        }
        let applied = applied.with_children(self);
        for index in self.tree.order.clone() {
            if self.tree.merges(index) {
                continue;
            }
            if let Some((joint, reaction)) = self.reaction_of_tree(index, applied[index], forces.wrenches[index]) {
                self.reactions[joint] = reaction;
            }
        }
    }

    /// The reaction of the joint between a child and its parent.
    fn reaction_of_tree(
        &self,
        child: usize,
        applied: Wrench<'g>,
        inertial: Wrench<'g>,
    ) -> Option<(usize, Reaction<'g>)> {
        let body = &self.bodies[child];
        let (motion, inboard) = (body.relative_motion.as_ref()?, self.tree.inboard[child]?);
        let (force, torque) = (body.rotate(inertial.force), body.rotate(inertial.torque));
        let wrench = Wrench { force: force - applied.force, torque: torque - applied.torque };
        let (mut force, mut torque) = (wrench.force, wrench.torque_about(body.rotate(motion.outboard_in_child)));
        let axes: Vec<Vector> = motion.rotations.iter().map(|axis| body.rotate(axis.in_child)).collect();
        match (self.joints[motion.joint].kind.mobilizer()?, axes.as_slice()) {
            (Mobilizer::FreeRotation, _) => torque = Vector::zero(self.g),
            (Mobilizer::TwoRotations { .. }, &[first, second]) => torque = along(torque, first.cross(second)),
            (Mobilizer::PlanarMotion { .. }, &[normal]) => {
                torque = across(torque, normal);
                force = along(force, normal);
            }
            (mobilizer, &[axis]) => {
                if mobilizer.axis_of(JointCoordinate::Angle).is_some() {
                    torque = across(torque, axis);
                }
                match motion.dofs.as_slice() {
                    // A thread pushes along its axis, and turns by as much as does no work with that.
                    [dof] if mobilizer.pitch().is_some() => {
                        let push = force.dot(axis);
                        let twist = dof.rotation[0] * dof.translation[0] * push;
                        torque = torque - twist * axis;
                    }
                    _ if mobilizer.axis_of(JointCoordinate::Displacement).is_some() => force = across(force, axis),
                    _ => {}
                }
            }
            _ => {}
        }
        if inboard.reversed {
            // The child is the joint's first body; the second feels the opposite, about its own point.
            (force, torque) = (-force, -torque);
            let from_second = motion.outboard_in_parent - self.local(inboard.parent);
            let arm = self.bodies[inboard.parent.body].rotate(from_second);
            torque += arm.cross(force);
        }
        Some((motion.joint, Reaction { force, magnitude: force.norm(), torque, about_axis: None, along_line: None }))
    }
}

/// The part of a vector along a unit vector.
fn along<'g>(a: Vector<'g>, axis: Vector<'g>) -> Vector<'g> {
    a.dot(axis) * axis
}

/// The part of a vector across a unit vector.
fn across<'g>(a: Vector<'g>, axis: Vector<'g>) -> Vector<'g> {
    a - a.dot(axis) * axis
}
