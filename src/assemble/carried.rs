//! A body's place and motion as its joint's coordinates say.
//!
//! With F₁, F₂ the joint's frames, A₁, A₂ their rotations in their bodies, u the axis, φ the angle, s the displacement, the
//! second body is turned by A₁ R(u, φ) A₂ᵀ against the first, and F₂'s origin is u s from that of F₁. Seen from the body
//! that carries (the first, or the second with φ and s reversed):
//!
//! ```text
//! R_c = R_p Rᵣ                    ω_c = ω_p + R_c a φ̇
//! r_c = r_p + R_p ρ − R_c f       ρ  = joint in p, with the displacement       f = joint in c       a = axis in c
//! ```

use symdiff::{Builder, Expr};

use crate::elements::joints::Mobilizer;
use crate::grammar::{JointCoordinate, PointRef};

use super::body::{ANGLE, Attitude, EULER, RotationCoordinates};
use super::error::BuildError;
use super::mechanism::{Context, Mechanism, Owner};
use super::rotation::{self, Quaternion};
use super::space::{self, Matrix, Vector};
use super::tree::Carrier;

/// A coordinate of the joint that carries a body.
#[derive(Clone, Copy, Debug)]
pub struct DegreeOfFreedom {
    /// Its place in q.
    pub index: usize,
    /// Turn about the axis for one of it.
    pub turn: Expr,
    /// Displacement along the axis for one of it.
    pub slide: Expr,
}

/// How a body is carried.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Body index.
    pub parent: usize,
    /// Joint index.
    pub joint: usize,
    /// Rᵣ: from the body's axes to those of its parent.
    pub rotation: Matrix,
    /// ρ: the joint's point on the body, in the parent's frame.
    pub reach: Vector,
    /// f: the same point in the body's own frame.
    pub foot: Vector,
    /// Unit vector of the joint's axis in the body's frame, and in the parent's.
    pub axis: [Vector; 2],
    /// φ̇, φ̈.
    pub turning: [Expr; 2],
    /// ṡ, s̈.
    pub sliding: [Expr; 2],
    /// The coordinates.
    pub dofs: Vec<DegreeOfFreedom>,
}

/// Entries of a rotation nearer than this to 0 or ±1 are so but for rounding.
const ROUNDING: f64 = 1e-15;

/// The matrix of a rotation that does not change. A quarter turn has zeros and ones, which cost nothing.
fn steady(g: &Builder, p: Quaternion) -> Matrix {
    rotation::matrix(g, p).map(|row| {
        row.map(|entry| match g.as_constant(entry) {
            Some(value) if (value - value.round()).abs() < ROUNDING => g.constant(value.round()),
            _ => entry,
        })
    })
}

impl Mechanism<'_> {
    /// Places a body on what carries it, which is placed already.
    pub fn carry(&mut self, g: &Builder, body: usize, carrier: Carrier) -> Result<(), BuildError> {
        let description = self.description;
        // What the tree uses has a mobilizer; without one a body would be welded.
        let Some(mobilizer) = description.joints[carrier.joint].kind.mobilizer() else { return Ok(()) };
        let dofs = self.dofs(g, &mobilizer, carrier)?;
        let along = |g: &Builder, list: &[Expr], part: fn(&DegreeOfFreedom) -> Expr| {
            let parts: Vec<Expr> = dofs.iter().map(|dof| g.mul(part(dof), list[dof.index])).collect();
            g.sum(parts)
        };
        let turn = |dof: &DegreeOfFreedom| dof.turn;
        let slide = |dof: &DegreeOfFreedom| dof.slide;
        let angle = along(g, &self.q, turn);
        let turning = [along(g, &self.v, turn), along(g, &self.w, turn)];
        let displacement = along(g, &self.q, slide);
        let sliding = [along(g, &self.v, slide), along(g, &self.w, slide)];

        let axis = match mobilizer.axis() {
            Some(axis) => {
                let axis = self.vector(g, axis, Context::Parameters)?;
                space::unit(g, axis)
            }
            None => space::along(g, 2),
        };
        // The second frame may stand turned against the first, about its z; the axis is one of the first.
        let rest = match mobilizer.twist() {
            Some(angle) => self.formula(g, angle, Context::Parameters)?,
            None => g.constant(0.0),
        };
        let upright = space::along(g, 2);
        let twist = rotation::about(g, upright, rest);
        let [parent, child] = [carrier.parent, carrier.child].map(|point| self.local_frame(g, point));
        let (before, after) = if carrier.reversed {
            let back = rotation::conjugate(g, twist);
            (rotation::product(g, parent, back), rotation::conjugate(g, child))
        } else {
            let after = rotation::conjugate(g, child);
            (parent, rotation::product(g, twist, after))
        };
        let (r_before, r_after) = (steady(g, before), steady(g, after));
        let about = rotation::matrix_about(g, axis, angle);
        let half = space::product(g, &r_before, &about);
        let relative = space::product(g, &half, &r_after);
        let axis_in_parent = space::times(g, &r_before, axis);
        let back = space::transposed(&r_after);
        let axis_in_child = space::times(g, &back, axis);

        let moved = space::scale(g, displacement, axis_in_parent);
        let origin = self.local(g, carrier.parent);
        let reach = space::add(g, origin, moved);
        let foot = self.local(g, carrier.child);
        let carried = Carried {
            parent: carrier.parent.body,
            joint: carrier.joint,
            rotation: relative,
            reach,
            foot,
            axis: [axis_in_child, axis_in_parent],
            turning,
            sliding,
            dofs,
        };
        let turned = rotation::about(g, axis, angle);
        let turned = rotation::product(g, before, turned);
        let turned = rotation::product(g, turned, after);
        let own = if carrier.reversed { g.sub(angle, rest) } else { g.add(angle, rest) };
        self.place(g, body, carried, turned, own);
        Ok(())
    }

    /// The coordinates of a joint that carries; φ and s count from the body that carries.
    fn dofs(
        &mut self,
        g: &Builder,
        mobilizer: &Mobilizer,
        carrier: Carrier,
    ) -> Result<Vec<DegreeOfFreedom>, BuildError> {
        let (zero, one) = (g.constant(0.0), g.constant(if carrier.reversed { -1.0 } else { 1.0 }));
        let mut dofs = Vec::new();
        for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
            let (turn, slide) = match (mobilizer.pitch(), coordinate) {
                (Some(pitch), JointCoordinate::Angle) => {
                    let pitch = self.formula(g, pitch, Context::Parameters)?;
                    let advance = g.scale(1.0 / std::f64::consts::TAU, pitch);
                    (one, g.mul(one, advance))
                }
                (Some(_), JointCoordinate::Displacement) => continue,
                (None, JointCoordinate::Angle) => (one, zero),
                (None, JointCoordinate::Displacement) => (zero, one),
            };
            if mobilizer.axis_of(coordinate).is_some() {
                let index = self.add_coordinate(g, Owner::Joint(carrier.joint, coordinate));
                self.joint_coordinates.insert((carrier.joint, coordinate), index);
                dofs.push(DegreeOfFreedom { index, turn, slide });
            }
        }
        Ok(dofs)
    }

    /// The rotation of the frame at a point against its body's.
    fn local_frame(&self, g: &Builder, point: PointRef) -> Quaternion {
        let frame = point.point.and_then(|index| self.bodies[point.body].frames[index]);
        frame.unwrap_or_else(|| rotation::identity(g))
    }

    /// Position, velocity and acceleration in the ground's axes; `turned` is the rotation against the parent, in the plane
    /// by `angle`.
    fn place(&mut self, g: &Builder, index: usize, carried: Carried, turned: Quaternion, angle: Expr) {
        let parent = &self.bodies[carried.parent];
        let mut body = self.bodies[index].clone();
        let arm = parent.rotate(g, carried.reach);
        let axis = parent.rotate(g, carried.axis[1]);
        let (joint, joint_velocity) = (parent.position_of(g, arm), parent.velocity_of(g, arm));
        let joint_acceleration = parent.acceleration_of(g, arm);
        let omega = parent.angular_velocity(g);
        match body.turn {
            RotationCoordinates::Angle => {
                body.position[ANGLE] = g.add(parent.position[ANGLE], angle);
                body.velocity[ANGLE] = g.add(parent.velocity[ANGLE], carried.turning[0]);
                body.acceleration[ANGLE] = g.add(parent.acceleration[ANGLE], carried.turning[1]);
            }
            RotationCoordinates::Euler => {
                let orientation = parent.orientation(g);
                let p = rotation::product(g, orientation, turned);
                let parent_rotation = parent.matrix(g);
                let matrix = space::product(g, &parent_rotation, &carried.rotation);
                let turning = space::scale(g, carried.turning[0], axis);
                let total = space::add(g, omega, turning);
                let alpha = parent.angular_acceleration(g);
                let spin = space::scale(g, carried.turning[1], axis);
                let carried_along = space::cross(g, omega, turning);
                let alpha = space::add(g, alpha, spin);
                let alpha = space::add(g, alpha, carried_along);
                let rates = rotation::ground_rates(g, p);
                let velocity = rotation::transposed(g, 0.5, &rates, total);
                let mut acceleration = rotation::transposed(g, 0.5, &rates, alpha);
                // p̈ = ½ Eᵀ ω̇ − ¼ |ω|² p
                let square = space::dot(g, total, total);
                let pull = g.scale(0.25, square);
                for (value, component) in acceleration.iter_mut().zip(p) {
                    let part = g.mul(pull, component);
                    *value = g.sub(*value, part);
                }
                body.position[EULER..].copy_from_slice(&p);
                body.velocity[EULER..].copy_from_slice(&velocity);
                body.acceleration[EULER..].copy_from_slice(&acceleration);
                body.attitude = Some(Attitude { matrix, omega: total, alpha });
            }
        }

        // The joint's point moves with the parent and slides; the body's origin hangs on it.
        let slip = space::scale(g, carried.sliding[0], axis);
        let joint_velocity = space::add(g, joint_velocity, slip);
        let spin = space::scale(g, carried.sliding[1], axis);
        let across = space::cross(g, omega, slip);
        let coriolis = across.map(|component| g.scale(2.0, component));
        let joint_acceleration = space::add(g, joint_acceleration, spin);
        let joint_acceleration = space::add(g, joint_acceleration, coriolis);
        let back = carried.foot.map(|component| g.neg(component));
        let arm = body.rotate(g, back);
        body.position[..3].copy_from_slice(&joint);
        body.velocity[..3].copy_from_slice(&joint_velocity);
        body.acceleration[..3].copy_from_slice(&joint_acceleration);
        let origin = body.position_of(g, arm);
        let velocity = body.velocity_of(g, arm);
        let acceleration = body.acceleration_of(g, arm);
        body.position[..3].copy_from_slice(&origin);
        body.velocity[..3].copy_from_slice(&velocity);
        body.acceleration[..3].copy_from_slice(&acceleration);
        body.carried = Some(Box::new(carried));
        self.bodies[index] = body;
    }
}
