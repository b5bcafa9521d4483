//! Two frames, and their rotation and displacement against one another.
//!
//! q = (q₀, e) is the rotation of the second frame F₂ against the first F₁, as Euler parameters: q = p̄_F₁ ∘ p_F₂.

use symdiff::Scalar;

use super::point::Frame;
use super::rotation::Quaternion;
use super::vector::Vector;

/// The frames at the first and the second point.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'g> {
    /// F₁.
    pub first: Frame<'g>,
    /// F₂.
    pub second: Frame<'g>,
}

impl<'g> Pair<'g> {
    /// The first frame rotated by an angle about its z.
    pub fn turned(mut self, angle: Scalar<'g>) -> Self {
        if !angle.is_zero() {
            let rotation = Quaternion::about(Vector::along(angle.builder(), 2), angle);
            self.first.orientation = self.first.orientation * rotation;
        }
        self
    }

    /// q
    pub fn relative(&self) -> Quaternion<'g> {
        self.first.orientation.conjugate() * self.second.orientation
    }

    /// r_B − r_A, in the ground's axes.
    pub fn offset(&self) -> Vector<'g> {
        self.second.point.position - self.first.point.position
    }

    /// A direction of the first frame in the ground's axes.
    pub fn outward(&self, direction: Vector<'g>) -> Vector<'g> {
        self.first.orientation.matrix() * direction
    }

    /// A direction of the second frame in the ground's axes.
    pub fn outward_of_second(&self, direction: Vector<'g>) -> Vector<'g> {
        self.second.orientation.matrix() * direction
    }

    /// a · (r_B − r_A) with a direction of the first frame.
    pub fn displacement(&self, direction: Vector<'g>) -> Scalar<'g> {
        self.outward(direction).dot(self.offset())
    }

    /// Zero if the second frame is rotated about the axis (a unit vector) by the angle: 2 [cos(φ/2) e·a − sin(φ/2) q₀].
    pub fn turned_by(&self, axis: Vector<'g>, angle: Scalar<'g>) -> Scalar<'g> {
        let relative = self.relative();
        let half = 0.5 * angle;
        let (cos, sin) = (half.cos(), half.sin());
        let about = relative.vector_part().dot(axis);
        2.0 * (cos * about - sin * relative[0])
    }
}
