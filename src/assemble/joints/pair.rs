//! The two frames that a joint is between, and what it can constrain of them.
//!
//! q = (q₀, e) is the rotation of the second frame F₂ against the first F₁, as Euler parameters: q = p̄_F₁ ∘ p_F₂. A
//! virtual rotation δπ of the second body, in F₁'s axes, changes e by ½ (q₀ δπ + δπ × e), so a row
//!
//! ```text
//! Φ = 2 n · e = 0          1 row, rad
//! ```
//!
//! forbids rotations with a part about n: with all three n the frames are parallel; with the two normal to an axis, they
//! turn about it, by any angle. −Φ_qᵀ λ is the torque −λ (q₀ n + e × n), in F₁'s axes, on the second body and the opposite
//! on the first. Unlike products of axes, the row has no second solution in which an axis points backwards.

use symdiff::{Builder, Expr};

use crate::assemble::mechanism::{Frame, Mechanism};
use crate::assemble::rotation::{self, Quaternion};
use crate::assemble::space::{self, Vector};
use crate::model::PointRef;

use super::Row;

/// The frames at the first and the second point.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub first: Frame,
    pub second: Frame,
}

impl Pair {
    pub fn of(g: &Builder, m: &Mechanism, between: [PointRef; 2]) -> Self {
        let [first, second] = between.map(|point| m.frame(g, point));
        Self { first, second }
    }

    /// The first frame turned by an angle about its z.
    pub fn turned(mut self, g: &Builder, angle: Expr) -> Self {
        if !g.is_zero(angle) {
            let axis = space::along(g, 2);
            let turn = rotation::about(g, axis, angle);
            self.first.orientation = rotation::product(g, self.first.orientation, turn);
        }
        self
    }

    /// q.
    pub fn relative(&self, g: &Builder) -> Quaternion {
        let back = rotation::conjugate(g, self.first.orientation);
        rotation::product(g, back, self.second.orientation)
    }

    /// r_B − r_A, in the ground's axes.
    pub fn offset(&self, g: &Builder) -> Vector {
        space::sub(g, self.second.point.position, self.first.point.position)
    }

    /// A direction of the first frame in the ground's axes.
    pub fn outward(&self, g: &Builder, direction: Vector) -> Vector {
        rotation::matrix(g, self.first.orientation).map(|row| space::dot(g, row, direction))
    }

    /// A direction of the second frame in the ground's axes.
    pub fn outward_of_second(&self, g: &Builder, direction: Vector) -> Vector {
        rotation::matrix(g, self.second.orientation).map(|row| space::dot(g, row, direction))
    }

    /// a · (r_B − r_A) with a direction of the first frame.
    pub fn displacement(&self, g: &Builder, direction: Vector) -> Expr {
        let direction = self.outward(g, direction);
        let offset = self.offset(g);
        space::dot(g, direction, offset)
    }

    /// Zero where the second frame is turned about the axis (a unit vector) by the angle: 2 [cos(φ/2) e·a − sin(φ/2) q₀].
    pub fn turned_by(&self, g: &Builder, axis: Vector, angle: Expr) -> Expr {
        let relative = self.relative(g);
        let half = g.scale(0.5, angle);
        let (cos, sin) = (g.cos(half), g.sin(half));
        let about = space::dot(g, rotation::vector_part(relative), axis);
        let (left, right) = (g.mul(cos, about), g.mul(sin, relative[0]));
        let half = g.sub(left, right);
        g.scale(2.0, half)
    }

    /// No displacement along n, a unit vector of the first frame: Φ = n₁ · (r_B − r_A), m. −Φ_qᵀ λ is the force −λ n₁ at B
    /// on the second body and the opposite on the first, at the same place.
    pub fn normal_row(&self, g: &Builder, name: &'static str, normal: Vector) -> Row {
        let normal = self.outward(g, normal);
        let offset = self.offset(g);
        let value = space::dot(g, normal, offset);
        Row { name, value, force: space::neg(g, normal), torque: space::zero(g) }
    }

    /// No rotation with a part about n, a unit vector of the first frame.
    pub fn turn_row(&self, g: &Builder, name: &'static str, normal: Vector) -> Row {
        let relative = self.relative(g);
        let e = rotation::vector_part(relative);
        let half = space::dot(g, normal, e);
        let value = g.scale(2.0, half);
        let (straight, across) = (space::scale(g, relative[0], normal), space::cross(g, e, normal));
        let torque = space::add(g, straight, across);
        let torque = self.outward(g, torque);
        Row { name, value, force: space::zero(g), torque: space::neg(g, torque) }
    }

    /// The frames turn about nothing.
    pub fn parallel(&self, g: &Builder) -> [Row; 3] {
        let names = ["turn_x", "turn_y", "turn_z"];
        std::array::from_fn(|axis| {
            let normal = space::along(g, axis);
            self.turn_row(g, names[axis], normal)
        })
    }

    /// The frames turn about the axis alone.
    pub fn coaxial(&self, g: &Builder, m: &Mechanism, axis: Vector) -> [Row; 2] {
        let [first, second] = normals(g, m, axis);
        [self.turn_row(g, "tilt_1", first), self.turn_row(g, "tilt_2", second)]
    }

    /// The second point stays on the line through the first along the axis.
    pub fn on_line(&self, g: &Builder, m: &Mechanism, axis: Vector) -> [Row; 2] {
        let [first, second] = normals(g, m, axis);
        [self.normal_row(g, "normal_1", first), self.normal_row(g, "normal_2", second)]
    }
}

/// Two unit vectors normal to a unit vector and to one another. Which axis of the frame they lean on is decided at the
/// nominal parameters: the one that the vector is farthest from.
fn normals(g: &Builder, m: &Mechanism, axis: Vector) -> [Vector; 2] {
    let size = m.nominal(g, &axis).into_iter().map(f64::abs).enumerate();
    let least = size.reduce(|best, next| if next.1 < best.1 { next } else { best }).map_or(0, |(index, _)| index);
    let lean = space::along(g, least);
    let across = space::cross(g, axis, lean);
    let first = space::unit(g, across);
    [first, space::cross(g, axis, first)]
}
