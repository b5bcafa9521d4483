//! The element of a beam in space: bending about two axes, torsion, shear and tension, with large rotations.
//!
//! The frames at the ends have x along the beam. θ is the rotation vector of the second against the first, τ =
//! tan(|θ|/4) u along its axis u. The middle frame R_m is the first one turned by half of θ; in its axes stand
//!
//! ```text
//! d = r_B − r_A,   ℓ = |d|,   c = d/ℓ                        ψ = θ = 4 f τ,   f = atan|τ|/|τ| = 1 − τ²/3 + τ⁴/5 − …
//! e = ℓ − L + b_y c_y² + b_z c_z² + L (ψ_y² + ψ_z²)/24        by how much its sections are apart, m
//! V = ½ (EA/L) e² + ½ (k_y c_y² + k_z c_z²) + ½ (GJ ψ_x² + EI_y ψ_y² + EI_z ψ_z²)/L          J
//! k_y = 12 EI_z/(L (1 + Φ_z)),   k_z = 12 EI_y/(L (1 + Φ_y)),   Φ = 12 EI/(GA L²), zero without shear
//! b = L (1/10 − Φ²/2)/(1 + Φ)²
//! ```
//!
//! c_y and c_z are the mean slopes of the sections against the chord: with EI ψ/L they are the stiffness matrix of
//! Timoshenko's beam (Przemieniecki, *Theory of Matrix Structural Analysis* (1968), ch. 5). Without shear e is that of
//! the element in the plane ([`super`]); a part c/(1 + Φ) of the slope bends, and the sections shear by γ = c
//! Φ/(1 + Φ), which brings them nearer by L γ²/2. The middle frame turns by δμ = ½ (δα + δβ) − ½ τ × (δβ − δα), with δα
//! and δβ the rotations of the ends in its axes, and δτ = ¼ (1 + τ²)(δβ − δα) (conformal rotation vector: Milenković,
//! *Coordinates suitable for angular motion synthesis in robots* (1982)). So, with n = ∂V/∂d, m = ∂V/∂ψ and k = d × n,
//!
//! ```text
//! p = (1 + τ²)(f m + 2 f' τ (τ · m))                          f' by τ²
//! F_B = −R_m n,   F_A = R_m n,   τ_B = R_m (½ k − ½ k × τ − p),   τ_A = R_m (½ k + ½ k × τ + p)
//! ```
//!
//! Kelvin and Voigt's damping adds the damping time times the rate to each of e, c and ψ in n and m.

use symdiff::Scalar;

use crate::elements::effects::Forces;
use crate::grammar::PointRef;
use crate::multibody::{Frame, Matrix, Pair, Quaternion, Vector};

/// Length and stiffness of an element.
pub(super) struct SpatialBeam<'g> {
    /// L, m
    pub length: Scalar<'g>,
    /// EA, N
    pub axial: Scalar<'g>,
    /// GJ, N m²
    pub torsional: Scalar<'g>,
    /// EI about y and z, N m²
    pub bending: [Scalar<'g>; 2],
    /// Shear stiffness GA, N; `None` if the beam does not shear.
    pub shear: Option<Scalar<'g>>,
    /// s
    pub damping: Scalar<'g>,
}

/// Measured quantities of an element.
pub(super) struct MeasuredBeam<'g> {
    /// ℓ, m
    pub length: Scalar<'g>,
    /// N, N
    pub tension: Scalar<'g>,
    /// Moments at the first and the second section, each in its own axes, N m: those by the following part on the
    /// preceding.
    pub moments: [Vector<'g>; 2],
}

/// How an element is bent and twisted, or how fast, in the middle frame.
#[derive(Clone, Copy)]
struct Shape<'g> {
    /// c_y, c_z
    slopes: [Scalar<'g>; 2],
    /// ψ
    rotation: Vector<'g>,
}

/// The ends as the middle frame sees them.
struct Middle<'g> {
    pair: Pair<'g>,
    /// R_m
    outward: Matrix<'g>,
    /// τ
    half: Vector<'g>,
    /// d
    offset: Vector<'g>,
    /// ḋ as the middle frame sees it.
    growth: Vector<'g>,
    /// The angular velocity of the second end against the first.
    spin: Vector<'g>,
}

impl<'g> Middle<'g> {
    fn of(forces: &dyn Forces<'g>, between: [PointRef; 2]) -> Self {
        let pair = forces.pair(between);
        let relative = pair.relative();
        // tan(|θ|/2) u, whatever the signs of the Euler parameters.
        let whole = relative.vector_part() / relative[0];
        let half = whole / (1.0 + (1.0 + whole.dot(whole)).sqrt());
        let [x, y, z] = half.components();
        let turn = Quaternion::from([x.builder().number(1.0), x, y, z]).normalised();
        let outward = (pair.first.orientation * turn).matrix();
        let inward = outward.transposed();
        let [first, second] = between.map(|point| inward * forces.angular_velocity(point.body));
        let spin = second - first;
        let turning = 0.5 * (first + second) - 0.5 * half.cross(spin);
        let offset = inward * pair.offset();
        let growth = inward * (pair.second.point.velocity - pair.first.point.velocity) - turning.cross(offset);
        Self { pair, outward, half, offset, growth, spin }
    }

    /// f and f'.
    fn series(&self) -> [Scalar<'g>; 2] {
        let x = self.half.dot(self.half);
        let value = 1.0 + x * (-1.0 / 3.0 + x * (0.2 + x * (-1.0 / 7.0 + 1.0 / 9.0 * x)));
        let slope = -1.0 / 3.0 + x * (0.4 + x * (-3.0 / 7.0 + 4.0 / 9.0 * x));
        [value, slope]
    }

    /// (1 + τ²)(f a + 2 f' τ (τ · a)): ψ̇ of the relative angular velocity, and the torque of m.
    fn conformal(&self, a: Vector<'g>) -> Vector<'g> {
        let [f, slope] = self.series();
        let grown = 1.0 + self.half.dot(self.half);
        grown * (f * a + 2.0 * slope * self.half.dot(a) * self.half)
    }
}

impl<'g> SpatialBeam<'g> {
    /// Adds its forces and its potential between two frames.
    pub fn apply(&self, forces: &mut dyn Forces<'g>, between: [PointRef; 2]) -> MeasuredBeam<'g> {
        let middle = Middle::of(forces, between);
        let (offset, growth) = (middle.offset, middle.growth);
        let length = offset.norm();
        let chord = offset / length;
        let rate = chord.dot(growth);
        let rotation = 4.0 * middle.series()[0] * middle.half;
        let shape = Shape { slopes: [chord[1], chord[2]], rotation };
        let slopes = [1, 2].map(|axis| (growth[axis] - rate * chord[axis]) / length);
        let shape_rate = Shape { slopes, rotation: middle.conformal(middle.spin) };
        let stretch = length - self.length + self.bow(&shape, &shape);
        let stretching = rate + 2.0 * self.bow(&shape, &shape_rate);

        let tension = self.axial / self.length * (stretch + self.damping * stretching);
        let felt = shape.after(self.damping, &shape_rate);
        let pull = tension * self.length;
        let zero = length.builder().number(0.0);
        let [about_y, about_z] = std::array::from_fn(|axis| {
            self.slope_stiffness()[axis] * felt.slopes[axis] + 2.0 * tension * self.bows()[axis] * shape.slopes[axis]
        });
        let across = Vector::from([zero, about_y, about_z]);
        let force = tension * chord + (across - across.dot(chord) * chord) / length;
        let straightening = 1.0 / 12.0 * pull * Vector::from([zero, rotation[1], rotation[2]]);
        let moment = self.rotation_stiffness().weighting(felt.rotation) + straightening;

        let turning = middle.conformal(moment);
        let lever = offset.cross(force);
        let aside = lever.cross(middle.half);
        let torques = [0.5 * (lever + aside) + turning, 0.5 * (lever - aside) - turning];
        let torques = torques.map(|torque| middle.outward * torque);
        let [first, second] = [middle.pair.first, middle.pair.second];
        forces.between(&first.point, &second.point, -(middle.outward * force));
        for (frame, torque) in [(first, torques[0]), (second, torques[1])] {
            forces.torque(0, frame.point.body, torque);
        }
        let [y, z] = self.bending;
        let given: Vec<_> = [self.axial, self.torsional, y, z, self.length].into_iter().chain(self.shear).collect();
        forces.potential(&given, 0.5 * (self.axial / self.length * (stretch * stretch) + self.doubled_energy(&shape)));
        let felt_at = |frame: Frame<'g>, torque| frame.orientation.matrix().transposed() * torque;
        MeasuredBeam { length, tension, moments: [felt_at(first, torques[0]), -felt_at(second, torques[1])] }
    }

    /// The bilinear form of which e has the square: b_y c_y² + b_z c_z² + L (ψ_y² + ψ_z²)/24.
    fn bow(&self, a: &Shape<'g>, b: &Shape<'g>) -> Scalar<'g> {
        let [y, z] = self.bows();
        let slanted = y * a.slopes[0] * b.slopes[0] + z * a.slopes[1] * b.slopes[1];
        let turned = a.rotation[1] * b.rotation[1] + a.rotation[2] * b.rotation[2];
        slanted + 1.0 / 24.0 * self.length * turned
    }

    /// b_y, b_z
    fn bows(&self) -> [Scalar<'g>; 2] {
        let [about_y, about_z] = self.bending;
        [about_z, about_y].map(|bending| match self.shear {
            None => 0.1 * self.length,
            Some(shear) => bow_of_shear(shear_number(bending, shear, self.length)) * self.length,
        })
    }

    /// k_y c_y² + k_z c_z² + (GJ ψ_x² + EI_y ψ_y² + EI_z ψ_z²)/L
    fn doubled_energy(&self, shape: &Shape<'g>) -> Scalar<'g> {
        let [y, z] = self.slope_stiffness();
        let slanted = y * (shape.slopes[0] * shape.slopes[0]) + z * (shape.slopes[1] * shape.slopes[1]);
        slanted + shape.rotation.dot(self.rotation_stiffness().weighting(shape.rotation))
    }

    /// k_y, k_z
    fn slope_stiffness(&self) -> [Scalar<'g>; 2] {
        let [about_y, about_z] = self.bending;
        [about_z, about_y].map(|bending| {
            let stiffness = 12.0 * bending / self.length;
            self.shear.map_or(stiffness, |shear| stiffness / (1.0 + shear_number(bending, shear, self.length)))
        })
    }

    /// GJ/L, EI_y/L, EI_z/L
    fn rotation_stiffness(&self) -> Vector<'g> {
        let [about_y, about_z] = self.bending;
        Vector::from([self.torsional, about_y, about_z]) / self.length
    }
}

/// Φ = 12 EI/(GA L²)
pub(super) fn shear_number<'g>(bending: Scalar<'g>, shear: Scalar<'g>, length: Scalar<'g>) -> Scalar<'g> {
    12.0 * bending / (shear * length * length)
}

/// b/L, by Φ.
pub(super) fn bow_of_shear(number: Scalar<'_>) -> Scalar<'_> {
    (0.1 - 0.5 * number * number) / (1.0 + number).powi(2)
}

impl<'g> Shape<'g> {
    /// Value after a time at a rate.
    fn after(&self, time: Scalar<'g>, rate: &Self) -> Self {
        Self {
            slopes: std::array::from_fn(|axis| self.slopes[axis] + time * rate.slopes[axis]),
            rotation: self.rotation + time * rate.rotation,
        }
    }
}
