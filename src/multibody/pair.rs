//! Two frames, and their rotation and displacement against one another.
//!
//! q = (q₀, e) is the rotation of the second frame F₂ against the first F₁, as Euler parameters: q = p̄_F₁ ∘ p_F₂.

use symdiff::{Builder, Expr};

use super::point::Frame;
use super::rotation::{self, Quaternion};
use super::space::{self, Vector};

/// The frames at the first and the second point.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// F₁.
    pub first: Frame,
    /// F₂.
    pub second: Frame,
}

impl Pair {
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
}
