//! Newton–Euler recursion: the inertial forces of bodies that joints carry, as generalised forces.
//!
//! In each body's own axes, with ω, ω̇ and the acceleration a of its origin, outwards from a root
//!
//! ```text
//! U = ω̇̃ + ω̃ ω̃          ω_c = Rᵣᵀ ω_p + u φ̇          ω̇_c = Rᵣᵀ ω̇_p + u φ̈ + (Rᵣᵀ ω_p) × u φ̇
//! a_c = Rᵣᵀ (a_p + U_p ρ + 2 ω_p × e ṡ + e s̈) − U_c f
//! ```
//!
//! u and e being the joint's axis in the body's and in its parent's frame, and back, m s being the body's first and
//! Σ = ½ tr J₀ 1 − J₀ its second moment of mass about the origin,
//!
//! ```text
//! F = m a + U m s          N = m s × a + 2 ax(U Σ)          ax(A) = ½ (A₃₂ − A₂₃, A₁₃ − A₃₁, A₂₁ − A₁₂)
//! φ: u · (N − f × F),   s: u · F          onto the parent: Rᵣ F,   Rᵣ (N − f × F) + ρ × Rᵣ F
//! ```
//!
//! A uniform field of acceleration g enters as −g on the roots, so that weights need no terms of their own. (Luh, Walker &
//! Paul, J. Dyn. Syst. Meas. Control 102 (1980) 69; with U, Khalil & Dombre, *Modeling, Identification and Control of
//! Robots*, ch. 9.) The generalised forces are linear in w; their slopes are the mass matrix.

use symdiff::{Builder, Expr};

use crate::grammar::JointCoordinate;

use super::applied_forces::AppliedForces;
use super::body::{Body, EULER, RotationCoordinates};
use super::joints::Reaction;
use super::mechanism::Mechanism;
use super::rotation;
use super::space::{self, Matrix, Vector};

/// How a body's frame moves, in its own axes.
#[derive(Clone, Copy)]
struct Motion {
    omega: Vector,
    alpha: Vector,
    acceleration: Vector,
    /// U.
    spread: Matrix,
}

impl Motion {
    fn new(g: &Builder, omega: Vector, alpha: Vector, acceleration: Vector) -> Self {
        Self { omega, alpha, acceleration, spread: spread(g, omega, alpha) }
    }
}

/// A force, and a torque about a body's origin.
pub type Wrench = [Vector; 2];

/// What it takes to move the carried bodies.
pub struct InertialForces {
    /// On each coordinate, n.
    pub generalised: Vec<Expr>,
    /// On each body, of it and all that it carries, in its own axes; zero where it is a root that carries nothing.
    pub wrenches: Vec<Wrench>,
}

/// The inertial forces of all carried bodies, less their weight in a uniform field of acceleration (m/s², in the
/// ground's axes).
pub fn inertial_forces(g: &Builder, m: &Mechanism, field: Vector) -> InertialForces {
    let zero = space::zero(g);
    let mut forces =
        InertialForces { generalised: vec![g.constant(0.0); m.q.len()], wrenches: vec![[zero; 2]; m.bodies.len()] };
    let mut motions: Vec<Option<Motion>> = vec![None; m.bodies.len()];
    for &index in &m.tree.order {
        let body = &m.bodies[index];
        let Some(carried) = &body.carried else { continue };
        let parent = match motions[carried.parent] {
            Some(motion) => motion,
            None => *motions[carried.parent].insert(root(g, &m.bodies[carried.parent], field)),
        };
        let motion = carried_motion(g, body, &parent);
        forces.wrenches[index] = inertial_wrench(g, body, &motion);
        motions[index] = Some(motion);
    }
    for &index in m.tree.order.iter().rev() {
        let Some(carried) = &m.bodies[index].carried else { continue };
        let [force, torque] = forces.wrenches[index];
        let moment = space::cross(g, carried.foot, force);
        let at_joint = space::sub(g, torque, moment);
        let (about, along) = (space::dot(g, carried.axis[0], at_joint), space::dot(g, carried.axis[0], force));
        for dof in &carried.dofs {
            let (turn, slide) = (g.mul(dof.turn, about), g.mul(dof.slide, along));
            forces.generalised[dof.index] = g.add(turn, slide);
        }
        let force = space::times(g, &carried.rotation, force);
        let torque = space::times(g, &carried.rotation, at_joint);
        let moment = space::cross(g, carried.reach, force);
        let torque = space::add(g, torque, moment);
        let [parent_force, parent_torque] = &mut forces.wrenches[carried.parent];
        *parent_force = space::add(g, *parent_force, force);
        *parent_torque = space::add(g, *parent_torque, torque);
    }
    for (body, &wrench) in m.bodies.iter().zip(&forces.wrenches) {
        on_root(g, body, wrench, &mut forces.generalised);
    }
    forces
}

/// A root moves as its own coordinates say, in the field.
fn root(g: &Builder, body: &Body, field: Vector) -> Motion {
    let felt = space::sub(g, [body.acceleration[0], body.acceleration[1], body.acceleration[2]], field);
    let back = space::transposed(&body.matrix(g));
    let acceleration = space::times(g, &back, felt);
    let (omega, alpha) = (body.angular_velocity_in_body(g), body.angular_acceleration_in_body(g));
    Motion::new(g, omega, alpha, acceleration)
}

fn carried_motion(g: &Builder, body: &Body, parent: &Motion) -> Motion {
    let Some(carried) = &body.carried else { return *parent };
    let [axis, axis_in_parent] = carried.axis;
    let back = space::transposed(&carried.rotation);
    let handed = space::times(g, &back, parent.omega);
    let own = space::scale(g, carried.turning[0], axis);
    let omega = space::add(g, handed, own);
    let gyration = space::cross(g, handed, own);
    let handed = space::times(g, &back, parent.alpha);
    let own = space::scale(g, carried.turning[1], axis);
    let alpha = space::add(g, handed, own);
    let alpha = space::add(g, alpha, gyration);

    let swung = space::times(g, &parent.spread, carried.reach);
    let acceleration = space::add(g, parent.acceleration, swung);
    let slip = space::scale(g, carried.sliding[0], axis_in_parent);
    let half = space::cross(g, parent.omega, slip);
    let coriolis = half.map(|component| g.scale(2.0, component));
    let acceleration = space::add(g, acceleration, coriolis);
    let speeding = space::scale(g, carried.sliding[1], axis_in_parent);
    let acceleration = space::add(g, acceleration, speeding);
    let acceleration = space::times(g, &back, acceleration);
    let motion = Motion::new(g, omega, alpha, acceleration);
    let swung = space::times(g, &motion.spread, carried.foot);
    Motion { acceleration: space::sub(g, acceleration, swung), ..motion }
}

/// U = ω̇̃ + ω̃ ω̃.
fn spread(g: &Builder, omega: Vector, alpha: Vector) -> Matrix {
    let squares = omega.map(|component| g.mul(component, component));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if i == j {
                let sum = g.add(squares[(i + 1) % 3], squares[(i + 2) % 3]);
                return g.neg(sum);
            }
            let product = g.mul(omega[i], omega[j]);
            let other = alpha[3 - i - j];
            if (i + 1) % 3 == j { g.sub(product, other) } else { g.add(product, other) }
        })
    })
}

/// F and N of the body alone.
fn inertial_wrench(g: &Builder, body: &Body, motion: &Motion) -> Wrench {
    let first = space::scale(g, body.mass, body.center);
    let straight = space::scale(g, body.mass, motion.acceleration);
    let swung = space::times(g, &motion.spread, first);
    let force = space::add(g, straight, swung);

    let inertia = body.inertia_about_origin(g);
    let trace = g.sum((0..3).map(|i| inertia[i][i]));
    let half = g.scale(0.5, trace);
    let second: Matrix = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { g.sub(half, inertia[i][j]) } else { g.neg(inertia[i][j]) })
    });
    let turned = match body.turn {
        // Of its inertia only that about z is known, and nothing else turns.
        RotationCoordinates::Angle => {
            let zero = g.constant(0.0);
            [zero, zero, g.mul(inertia[2][2], motion.alpha[2])]
        }
        RotationCoordinates::Euler => {
            let product = space::product(g, &motion.spread, &second);
            std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                g.sub(product[k][j], product[j][k])
            })
        }
    };
    let moment = space::cross(g, first, motion.acceleration);
    [force, space::add(g, moment, turned)]
}

/// What a root's own coordinates feel of what it carries.
fn on_root(g: &Builder, body: &Body, [force, torque]: Wrench, generalised: &mut [Expr]) {
    if body.carried.is_some() || body.index.iter().all(Option::is_none) {
        return;
    }
    let force = body.rotate(g, force);
    let zero = g.constant(0.0);
    let turning = match body.turn {
        RotationCoordinates::Angle => [torque[2], zero, zero, zero],
        RotationCoordinates::Euler => {
            let rates = rotation::body_rates(g, body.euler());
            rotation::transposed(g, 2.0, &rates, torque)
        }
    };
    let parts = [(0, force[0]), (1, force[1]), (2, force[2])].into_iter();
    for (dof, part) in parts.chain((EULER..).zip(turning)) {
        if let Some(row) = body.index.get(dof).copied().flatten() {
            generalised[row] = g.add(generalised[row], part);
        }
    }
}

impl Mechanism<'_> {
    /// The reactions of the joints that carry, in the ground's axes: what moves a body and all that it carries, less the
    /// forces on them and the reactions of the joints `closures`, which are constraints. Along its own coordinates a joint
    /// has none.
    pub fn react(&mut self, g: &Builder, applied: &AppliedForces, forces: &InertialForces, closures: &[usize]) {
        let mut applied = applied.clone();
        for &joint in closures {
            let Reaction { force, torque, .. } = self.reactions[joint];
            let Some([first, second]) = self.description.joints[joint].kind.between() else { continue };
            let place = self.point(g, second);
            applied.add_force(g, &place, force);
            let at_first = self.carried_along(g, first.body, place.position);
            let opposite = space::neg(g, force);
            applied.add_force(g, &at_first, opposite);
            applied.add_torque_pair(g, first.body, second.body, torque);
        }
        let applied = applied.carried_on(g, self);
        for &index in self.tree.order.iter().filter(|&&index| !self.tree.merges(index)) {
            let body = &self.bodies[index];
            let (Some(carried), Some(carrier)) = (&body.carried, self.tree.carriers[index]) else { continue };
            let [force, torque] = forces.wrenches[index].map(|part| body.rotate(g, part));
            let [fx, fy, fz, tx, ty, tz] = applied[index];
            let force = space::sub(g, force, [fx, fy, fz]);
            let torque = space::sub(g, torque, [tx, ty, tz]);
            let foot = body.rotate(g, carried.foot);
            let moment = space::cross(g, foot, force);
            let torque = space::sub(g, torque, moment);
            let axis = body.rotate(g, carried.axis[0]);
            let kind = &self.description.joints[carried.joint].kind;
            let free = |coordinate| kind.axis_of(coordinate).is_some();
            let (slides, turns) = (free(JointCoordinate::Displacement), free(JointCoordinate::Angle));
            let is_helix = kind.mobilizer().is_some_and(|mobilizer| mobilizer.pitch().is_some());
            let mut torque = if turns { across(g, torque, axis) } else { torque };
            let mut force = force;
            match carried.dofs.as_slice() {
                // A thread pushes along its axis, and turns by as much as does no work with that.
                [dof] if is_helix => {
                    let push = space::dot(g, force, axis);
                    let advance = g.mul(dof.turn, dof.slide);
                    let turning = g.mul(advance, push);
                    let turning = space::scale(g, turning, axis);
                    torque = space::sub(g, torque, turning);
                }
                _ if slides => force = across(g, force, axis),
                _ => {}
            }
            if carrier.reversed {
                // It is the first body that is carried; the second feels the opposite, about its own point.
                (force, torque) = (space::neg(g, force), space::neg(g, torque));
                let origin = self.local(g, carrier.parent);
                let from_second = space::sub(g, carried.reach, origin);
                let arm = self.bodies[carried.parent].rotate(g, from_second);
                let moment = space::cross(g, arm, force);
                torque = space::add(g, torque, moment);
            }
            let magnitude = space::norm(g, force);
            self.reactions[carried.joint] = Reaction { force, magnitude, torque, about_axis: None };
        }
    }
}

/// The part of a vector across a unit vector.
fn across(g: &Builder, a: Vector, axis: Vector) -> Vector {
    let along = space::dot(g, a, axis);
    let part = space::scale(g, along, axis);
    space::sub(g, a, part)
}
