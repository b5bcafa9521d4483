//! Rotations by Euler parameters, as expressions.
//!
//! p = (p₀, e), pᵀp = 1, is a rotation by φ about the unit vector u: p₀ = cos(φ/2), e = u sin(φ/2). With ã b = a × b,
//!
//! ```text
//! R = (p₀² − eᵀe) 1 + 2 e eᵀ + 2 p₀ ẽ = E Gᵀ          E = [−e  p₀ 1 + ẽ],   G = [−e  p₀ 1 − ẽ]          3 × 4
//! ω = 2 E ṗ,   ω' = Rᵀ ω = 2 G ṗ                       ω̇ = 2 E p̈,   ω̇' = 2 G p̈
//! ṗ = ½ Eᵀ ω = ½ Gᵀ ω'                                 E Eᵀ = G Gᵀ = pᵀp 1,   E p = G p = 0
//! ```
//!
//! ω in the ground's axes, ω' in the body's. A torque τ (τ' in the body's axes) has the generalised forces 2 Eᵀ τ = 2
//! Gᵀ τ' on p, since 2 E δp is the virtual rotation. (Nikravesh, *Computer-Aided Analysis of Mechanical Systems*, ch.
//! 6.) A second rotation in the rotated frame multiplies from the right: R(p) R(r) = R(p ∘ r).

use std::ops::{Index, Mul};

use symdiff::{Builder, Scalar};

use super::matrix::Matrix;
use super::vector::Vector;

/// A rotation as Euler parameters p = (p₀, e), or their derivative by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<'g>([Scalar<'g>; 4]);

impl<'g> Quaternion<'g> {
    /// No rotation.
    pub fn identity(g: &'g Builder) -> Self {
        let (one, zero) = (g.number(1.0), g.number(0.0));
        Self([one, zero, zero, zero])
    }

    /// By an angle about a unit vector.
    pub fn about(axis: Vector<'g>, angle: Scalar<'g>) -> Self {
        let half = 0.5 * angle;
        let (cos, sin) = (half.cos(), half.sin());
        Self::of(cos, sin * axis)
    }

    /// About the fixed x, then y, then z.
    pub fn roll_pitch_yaw(angles: Vector<'g>) -> Self {
        let g = angles[0].builder();
        let [roll, pitch, yaw] = std::array::from_fn(|axis| Self::about(Vector::along(g, axis), angles[axis]));
        yaw * pitch * roll
    }

    fn of(scalar: Scalar<'g>, vector: Vector<'g>) -> Self {
        let [x, y, z] = vector.components();
        Self([scalar, x, y, z])
    }

    /// p₀ to p₃.
    pub fn components(self) -> [Scalar<'g>; 4] {
        self.0
    }

    /// e
    pub fn vector_part(self) -> Vector<'g> {
        let [_, x, y, z] = self.0;
        [x, y, z].into()
    }

    /// The inverse of a rotation.
    pub fn conjugate(self) -> Self {
        Self::of(self.0[0], -self.vector_part())
    }

    /// `pᵀ r`
    pub fn dot(self, other: Self) -> Scalar<'g> {
        self.0[0].builder().dot(&self.0, &other.0)
    }

    /// p / |p|
    pub fn normalised(self) -> Self {
        let length = self.dot(self).sqrt();
        Self(self.0.map(|component| component / length))
    }

    /// R
    pub fn matrix(self) -> Matrix<'g> {
        let p = self.0;
        let squares = p.map(|component| component * component);
        let all = squares[1..].iter().fold(squares[0], |rest, &square| rest - square);
        let [px, py, pz] = [1, 2, 3].map(|i| p[0] * p[i]);
        let [xy, xz, yz] = [(1, 2), (1, 3), (2, 3)].map(|(i, j)| p[i] * p[j]);
        let [xx, yy, zz] = [1, 2, 3].map(|i| all + 2.0 * squares[i]);
        let rows = [
            [xx, 2.0 * (xy - pz), 2.0 * (xz + py)],
            [2.0 * (xy + pz), yy, 2.0 * (yz - px)],
            [2.0 * (xz - py), 2.0 * (yz + px), zz],
        ];
        rows.map(Vector::from).into()
    }

    /// E: the rates of a rotation in the ground's axes.
    pub fn ground_rates(self) -> Rates<'g> {
        let p = self.0;
        let [n1, n2, n3] = (-self.vector_part()).components();
        Rates([[n1, p[0], n3, p[2]], [n2, p[3], p[0], n1], [n3, n2, p[1], p[0]]].map(Self))
    }

    /// G: the rates of a rotation in the body's axes.
    pub fn body_rates(self) -> Rates<'g> {
        let p = self.0;
        let [n1, n2, n3] = (-self.vector_part()).components();
        Rates([[n1, p[0], p[3], n2], [n2, n3, p[0], p[1]], [n3, p[2], n1, p[0]]].map(Self))
    }
}

impl<'g> From<[Scalar<'g>; 4]> for Quaternion<'g> {
    fn from(components: [Scalar<'g>; 4]) -> Self {
        Self(components)
    }
}

impl<'g> Index<usize> for Quaternion<'g> {
    type Output = Scalar<'g>;

    fn index(&self, component: usize) -> &Scalar<'g> {
        &self.0[component]
    }
}

/// p ∘ r = (p₀ r₀ − e·f, p₀ f + r₀ e + e × f)
impl Mul for Quaternion<'_> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (e, f) = (self.vector_part(), other.vector_part());
        let (scalars, dot) = (self.0[0] * other.0[0], e.dot(f));
        let vector = self.0[0] * f + other.0[0] * e + e.cross(f);
        Self::of(scalars - dot, vector)
    }
}

/// E or G, by rows.
#[derive(Clone, Copy, Debug)]
pub struct Rates<'g>([Quaternion<'g>; 3]);

impl<'g> Rates<'g> {
    /// 2 E ṗ or 2 G ṗ; 2 E p̈ or 2 G p̈.
    pub fn rotation(self, derivative: Quaternion<'g>) -> Vector<'g> {
        self.0.map(|row| 2.0 * row.dot(derivative)).into()
    }

    /// `factor` Eᵀ a or Gᵀ a: with 2 a torque's generalised forces, with ½ an angular velocity's ṗ.
    pub fn transposed_times(self, factor: f64, a: Vector<'g>) -> Quaternion<'g> {
        Quaternion(std::array::from_fn(|column| factor * self.column(column).dot(a)))
    }

    /// One of the four columns.
    pub fn column(self, column: usize) -> Vector<'g> {
        self.0.map(|row| row[column]).into()
    }
}

/// R of a rotation by an angle about a unit vector a: cos φ 1 + sin φ ã + (1 − cos φ) a aᵀ.
pub fn matrix_about<'g>(axis: Vector<'g>, angle: Scalar<'g>) -> Matrix<'g> {
    let (cos, sin) = (angle.cos(), angle.sin());
    let rest = 1.0 - cos;
    Matrix::from_fn(|i, j| {
        let both = axis[i] * axis[j];
        if i == j {
            // a² + (1 − a²) cos φ: nothing but 1 or cos φ about an axis of the frame.
            return both + (1.0 - both) * cos;
        }
        let straight = both * rest;
        let across = axis[3 - i - j] * sin;
        if (i + 1) % 3 == j { straight - across } else { straight + across }
    })
}

/// Roll, pitch and yaw of a rotation matrix, each between −π and π, pitch at most a right angle.
pub fn angles<'g>(r: &Matrix<'g>) -> [Scalar<'g>; 3] {
    directions(r).map(|(sin, cos)| sin.atan2(cos))
}

/// Sine and cosine of these angles, times their common factor.
pub fn directions<'g>(r: &Matrix<'g>) -> [(Scalar<'g>, Scalar<'g>); 3] {
    let (square, other) = (r[2][1] * r[2][1], r[2][2] * r[2][2]);
    let (level, down) = ((square + other).sqrt(), -r[2][0]);
    [(r[2][1], r[2][2]), (down, level), (r[1][0], r[0][0])]
}

#[cfg(test)]
mod tests {
    use super::*;

    type Numbers = [f64; 4];

    const P: Numbers = [0.5, -0.1, 0.7, 0.5];
    const RATE: Numbers = [0.3, 0.8, -0.2, 0.14];

    fn symbols<'g>(g: &'g Builder, name: &str) -> Quaternion<'g> {
        std::array::from_fn(|i| g.variable(&format!("{name}{i}"))).into()
    }

    /// Values where p is `P` and v is `RATE`.
    fn values<const N: usize>(scalars: [Scalar<'_>; N]) -> [f64; N] {
        let graph = scalars[0].builder().graph();
        let values = graph.evaluate(&scalars.map(Scalar::expr), |symbol| {
            let name = graph.symbol_name(symbol).unwrap();
            let index: usize = name[1..].parse().unwrap();
            if name.starts_with('p') { P[index] } else { RATE[index] }
        });
        values.try_into().unwrap()
    }

    fn entries(matrix: &Matrix) -> [[f64; 3]; 3] {
        matrix.rows().map(|row| values(row.components()))
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn the_matrix_is_a_rotation_and_its_derivative_turns_by_omega() {
        let g = &Builder::new();
        let (p, rate) = (symbols(g, "p"), symbols(g, "v"));
        let matrix = p.matrix();
        let omega = p.ground_rates().rotation(rate);
        let omega_in_body = p.body_rates().rotation(rate);
        let r = entries(&matrix);
        for i in 0..3 {
            for j in 0..3 {
                close((0..3).map(|k| r[i][k] * r[j][k]).sum(), f64::from(u8::from(i == j)));
            }
        }
        // Ṙ = ω × R, column by column; ω = R ω'.
        let (omega, in_body) = (values(omega.components()), values(omega_in_body.components()));
        for i in 0..3 {
            close((0..3).map(|k| r[i][k] * in_body[k]).sum(), omega[i]);
            for j in 0..3 {
                let slopes = values(p.components().map(|symbol| matrix[i][j].derivative(symbol)));
                let change: f64 = slopes.iter().zip(RATE).map(|(slope, rate)| slope * rate).sum();
                let (k, l) = ((i + 1) % 3, (i + 2) % 3);
                close(change, omega[k] * r[l][j] - omega[l] * r[k][j]);
            }
        }
        let back = p.body_rates().transposed_times(0.5, in_body.map(|component| g.number(component)).into());
        for (found, wanted) in values(back.components()).into_iter().zip(RATE) {
            close(found, wanted);
        }
    }

    #[test]
    fn products_compose_rotations_in_order() {
        let g = &Builder::new();
        let angles = [0.3, -0.7, 1.9];
        let p = Quaternion::roll_pitch_yaw(angles.map(|angle| g.number(angle)).into());
        for (found, wanted) in values(self::angles(&p.matrix())).into_iter().zip(angles) {
            close(found, wanted);
        }
        // R(z, π/2) R(x, π/2) takes z to x: first in the rotated frame, −y, then rotated by z.
        let right = g.number(std::f64::consts::FRAC_PI_2);
        let [about_x, about_z] = [0, 2].map(|axis| Quaternion::about(Vector::along(g, axis), right));
        let both = about_z * about_x;
        let r = entries(&both.matrix());
        close(r[0][2], 1.0);
        close(r[1][2], 0.0);
        let none = both.conjugate() * both;
        close(values(none.components())[0], 1.0);
    }
}
