//! Displacement of a frame against another one, both near a known relative position with parallel axes.
//!
//! In the axes of the first frame, R its orientation and X the second one's origin at rest:
//!
//! ```text
//! d = Rᵀ (r_B − r_A) − X,     ḋ = Rᵀ (ṙ_B − ṙ_A − ω_A × (r_B − r_A))          m, m/s
//! d̈ = Rᵀ (r̈_B − r̈_A − ω̇_A × (r_B − r_A) − ω_A × (ω_A × (r_B − r_A))) − 2 Ω × ḋ,     Ω = Rᵀ ω_A
//! ρ = 2 tan(θ/2) n,           ρ̇ = w + ½ w × ρ + ¼ ρ (ρ · w),     w = Rᵀ (ω_B − ω_A)          rad, rad/s
//! ```
//!
//! ρ is Rodrigues' vector, which is the rotation vector up to θ³/12.

use super::matrix::Matrix;
use super::pair::Pair;
use super::vector::Vector;

/// Displacement of a frame from its rest position against another.
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
    /// Displacement of the second frame of a pair, at rest at X.
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

    /// d̈ and ρ̈, from the angular velocities of both bodies and the accelerations of both origins and bodies, in the
    /// ground's axes.
    pub fn second_rates(
        &self,
        pair: &Pair<'g>,
        [first, second]: [Vector<'g>; 2],
        [[a_first, alpha_first], [a_second, alpha_second]]: [[Vector<'g>; 2]; 2],
    ) -> [Vector<'g>; 2] {
        let inward = self.outward.transposed();
        let [rate, turning_rate] = self.rates(pair, [first, second]);
        let offset = pair.offset();
        let carried = alpha_first.cross(offset) + first.cross(first.cross(offset));
        let omega = inward * first;
        let moving = inward * (a_second - a_first - carried) - 2.0 * omega.cross(rate);
        let w = inward * (second - first);
        let change = inward * (alpha_second - alpha_first) - omega.cross(w);
        let (rho, part) = (self.rotation, 0.5 * (change.cross(self.rotation) + w.cross(turning_rate)));
        let along = 0.25 * (rho.dot(w) * turning_rate + (turning_rate.dot(w) + rho.dot(change)) * rho);
        [moving, change + part + along]
    }

    /// The torque, in the ground's axes, that does the work m · dρ.
    pub fn torque(&self, m: Vector<'g>) -> Vector<'g> {
        let along = 0.25 * self.rotation.dot(m);
        self.outward * (m + 0.5 * self.rotation.cross(m) + along * self.rotation)
    }
}
