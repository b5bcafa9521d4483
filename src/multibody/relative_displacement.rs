//! A frame against another one, where both are near a known relative position with parallel axes.
//!
//! In the axes of the first frame, R its orientation and X the second one's origin at rest:
//!
//! ```text
//! d = Rᵀ (r_B − r_A) − X,     ḋ = Rᵀ (ṙ_B − ṙ_A − ω_A × (r_B − r_A))          m, m/s
//! ρ = 2 tan(θ/2) n,           ρ̇ = w + ½ w × ρ + ¼ ρ (ρ · w),     w = Rᵀ (ω_B − ω_A)          rad, rad/s
//! ```
//!
//! ρ is Rodrigues' vector, which is the rotation vector up to θ³/12.

use super::matrix::Matrix;
use super::pair::Pair;
use super::vector::Vector;

/// How far a frame is from where it is at rest against another.
#[derive(Clone, Copy, Debug)]
pub struct RelativeDisplacement<'g> {
    /// R
    pub outward: Matrix<'g>,
    /// d
    pub displacement: Vector<'g>,
    /// ρ
    pub rotation: Vector<'g>,
}

impl<'g> RelativeDisplacement<'g> {
    /// Of the second frame of a pair, at rest at X.
    pub fn of(pair: &Pair<'g>, at_rest: Vector<'g>) -> Self {
        let outward = pair.first.orientation.matrix();
        let relative = pair.relative();
        let displacement = outward.transposed() * pair.offset() - at_rest;
        Self { outward, displacement, rotation: 2.0 * (relative.vector_part() / relative[0]) }
    }

    /// ḋ and ρ̇, from the angular velocities of both frames' bodies in the ground's axes.
    pub fn rates(&self, pair: &Pair<'g>, [first, second]: [Vector<'g>; 2]) -> [Vector<'g>; 2] {
        let inward = self.outward.transposed();
        let moving = pair.second.point.velocity - pair.first.point.velocity - first.cross(pair.offset());
        let turning = inward * (second - first);
        let along = 0.25 * self.rotation.dot(turning);
        [inward * moving, turning + 0.5 * turning.cross(self.rotation) + along * self.rotation]
    }

    /// The torque, in the ground's axes, that does the work m · dρ.
    pub fn torque(&self, m: Vector<'g>) -> Vector<'g> {
        let along = 0.25 * self.rotation.dot(m);
        self.outward * (m + 0.5 * self.rotation.cross(m) + along * self.rotation)
    }
}
