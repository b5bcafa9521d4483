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
//! ω in the ground's axes, ω' in the body's. A torque τ (τ' in the body's axes) has the generalised forces 2 Eᵀ τ = 2 Gᵀ τ'
//! on p, since 2 E δp is the virtual rotation. (Nikravesh, *Computer-Aided Analysis of Mechanical Systems*, ch. 6.)
//! A second rotation in the turned frame multiplies from the right: R(p) R(r) = R(p ∘ r).

use symdiff::{Builder, Expr};

use super::space::{self, Matrix, Vector};

/// p₀, p₁, p₂, p₃.
pub type Quaternion = [Expr; 4];

/// E or G.
pub type Rates = [[Expr; 4]; 3];

/// No rotation.
pub fn identity(g: &Builder) -> Quaternion {
    let (one, zero) = (g.constant(1.0), g.constant(0.0));
    [one, zero, zero, zero]
}

/// The inverse of a rotation.
pub fn conjugate(g: &Builder, p: Quaternion) -> Quaternion {
    [p[0], g.neg(p[1]), g.neg(p[2]), g.neg(p[3])]
}

/// p ∘ r = (p₀ r₀ − e·f, p₀ f + r₀ e + e × f).
pub fn product(g: &Builder, p: Quaternion, r: Quaternion) -> Quaternion {
    let (e, f) = (vector_part(p), vector_part(r));
    let (scalars, dot) = (g.mul(p[0], r[0]), space::dot(g, e, f));
    let (left, right) = (space::scale(g, p[0], f), space::scale(g, r[0], e));
    let sum = space::add(g, left, right);
    let cross = space::cross(g, e, f);
    let vector = space::add(g, sum, cross);
    [g.sub(scalars, dot), vector[0], vector[1], vector[2]]
}

/// e.
pub fn vector_part(p: Quaternion) -> Vector {
    [p[1], p[2], p[3]]
}

/// By an angle about a unit vector.
pub fn about(g: &Builder, axis: Vector, angle: Expr) -> Quaternion {
    let half = g.scale(0.5, angle);
    let (cos, sin) = (g.cos(half), g.sin(half));
    let e = space::scale(g, sin, axis);
    [cos, e[0], e[1], e[2]]
}

/// About the fixed x, then y, then z.
pub fn roll_pitch_yaw(g: &Builder, angles: [Expr; 3]) -> Quaternion {
    let [roll, pitch, yaw] = std::array::from_fn(|axis| {
        let axis_vector = space::along(g, axis);
        about(g, axis_vector, angles[axis])
    });
    let first = product(g, yaw, pitch);
    product(g, first, roll)
}

/// p / |p|.
pub fn normalised(g: &Builder, p: Quaternion) -> Quaternion {
    let square = g.dot(&p, &p);
    let length = g.sqrt(square);
    p.map(|component| g.div(component, length))
}

/// R, by rows.
pub fn matrix(g: &Builder, p: Quaternion) -> Matrix {
    let squares = p.map(|component| g.mul(component, component));
    let all = squares[1..].iter().fold(squares[0], |rest, &square| g.sub(rest, square));
    let [px, py, pz] = [1, 2, 3].map(|i| g.mul(p[0], p[i]));
    let [xy, xz, yz] = [(1, 2), (1, 3), (2, 3)].map(|(i, j)| g.mul(p[i], p[j]));
    let diagonal = |i: usize| {
        let twice = g.scale(2.0, squares[i]);
        g.add(all, twice)
    };
    let [xx, yy, zz] = [diagonal(1), diagonal(2), diagonal(3)];
    let twice = |a: Expr, b: Expr, plus: bool| {
        let sum = if plus { g.add(a, b) } else { g.sub(a, b) };
        g.scale(2.0, sum)
    };
    [
        [xx, twice(xy, pz, false), twice(xz, py, true)],
        [twice(xy, pz, true), yy, twice(yz, px, false)],
        [twice(xz, py, false), twice(yz, px, true), zz],
    ]
}

/// R of a rotation by an angle about a unit vector a: cos φ 1 + sin φ ã + (1 − cos φ) a aᵀ, by rows.
pub fn matrix_about(g: &Builder, axis: Vector, angle: Expr) -> Matrix {
    let (cos, sin, one) = (g.cos(angle), g.sin(angle), g.constant(1.0));
    let rest = g.sub(one, cos);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let both = g.mul(axis[i], axis[j]);
            if i == j {
                // a² + (1 − a²) cos φ: nothing but 1 or cos φ about an axis of the frame.
                let across = g.sub(one, both);
                let turning = g.mul(across, cos);
                return g.add(both, turning);
            }
            let straight = g.mul(both, rest);
            let across = g.mul(axis[3 - i - j], sin);
            if (i + 1) % 3 == j { g.sub(straight, across) } else { g.add(straight, across) }
        })
    })
}

/// E: rates of rotation in the ground's axes.
pub fn ground_rates(g: &Builder, p: Quaternion) -> Rates {
    let [n1, n2, n3] = vector_part(p).map(|component| g.neg(component));
    [[n1, p[0], n3, p[2]], [n2, p[3], p[0], n1], [n3, n2, p[1], p[0]]]
}

/// G: rates of rotation in the body's axes.
pub fn body_rates(g: &Builder, p: Quaternion) -> Rates {
    let [n1, n2, n3] = vector_part(p).map(|component| g.neg(component));
    [[n1, p[0], p[3], n2], [n2, n3, p[0], p[1]], [n3, p[2], n1, p[0]]]
}

/// 2 E ṗ or 2 G ṗ; 2 E p̈ or 2 G p̈.
pub fn turning(g: &Builder, rates: &Rates, derivative: Quaternion) -> Vector {
    rates.map(|row| {
        let half = g.dot(&row, &derivative);
        g.scale(2.0, half)
    })
}

/// `factor` Eᵀ a or Gᵀ a: with 2 a torque's generalised forces, with ½ an angular velocity's ṗ.
pub fn transposed(g: &Builder, factor: f64, rates: &Rates, a: Vector) -> Quaternion {
    std::array::from_fn(|i| {
        let sum = g.dot(&rates.map(|row| row[i]), &a);
        g.scale(factor, sum)
    })
}

/// Roll, pitch and yaw of a rotation matrix, each between −π and π, pitch at most a right angle.
pub fn angles(g: &Builder, r: &[Vector; 3]) -> [Expr; 3] {
    let (square, other) = (g.mul(r[2][1], r[2][1]), g.mul(r[2][2], r[2][2]));
    let sum = g.add(square, other);
    let (level, down) = (g.sqrt(sum), g.neg(r[2][0]));
    let atan2 = |y: Expr, x: Expr| g.binary(symdiff::Binary::Atan2, y, x);
    [atan2(r[2][1], r[2][2]), atan2(down, level), atan2(r[1][0], r[0][0])]
}

#[cfg(test)]
mod tests {
    use super::*;

    type Numbers = [f64; 4];

    const P: Numbers = [0.5, -0.1, 0.7, 0.5];
    const RATE: Numbers = [0.3, 0.8, -0.2, 0.14];

    fn symbols(g: &Builder, name: &str) -> Quaternion {
        std::array::from_fn(|i| g.symbol(&format!("{name}{i}")))
    }

    fn values(g: &Builder, exprs: &[Expr], p: Numbers, rate: Numbers) -> Vec<f64> {
        let graph = g.graph();
        graph.evaluate(exprs, |symbol| {
            let name = graph.symbol_name(symbol).unwrap();
            let index: usize = name[1..].parse().unwrap();
            if name.starts_with('p') { p[index] } else { rate[index] }
        })
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn the_matrix_is_a_rotation_and_its_derivative_turns_by_omega() {
        let g = &Builder::new();
        let (p, rate) = (symbols(g, "p"), symbols(g, "v"));
        let r = matrix(g, p);
        let rates = ground_rates(g, p);
        let omega = turning(g, &rates, rate);
        let rates = body_rates(g, p);
        let turned = turning(g, &rates, rate);
        let r_values = values(g, r.as_flattened(), P, RATE);
        let r_at = |i: usize, j: usize| r_values[3 * i + j];
        for i in 0..3 {
            for j in 0..3 {
                close((0..3).map(|k| r_at(i, k) * r_at(j, k)).sum(), f64::from(u8::from(i == j)));
            }
        }
        // Ṙ = ω × R, column by column; ω = R ω'.
        let (omega, turned) = (values(g, &omega, P, RATE), values(g, &turned, P, RATE));
        for (i, row) in r.iter().enumerate() {
            close((0..3).map(|k| r_at(i, k) * turned[k]).sum(), omega[i]);
            for (j, &entry) in row.iter().enumerate() {
                let slopes: Vec<Expr> = p.iter().map(|&symbol| g.derivative(entry, symbol)).collect();
                let change: f64 = values(g, &slopes, P, RATE).iter().zip(RATE).map(|(slope, rate)| slope * rate).sum();
                let (k, l) = ((i + 1) % 3, (i + 2) % 3);
                close(change, omega[k] * r_at(l, j) - omega[l] * r_at(k, j));
            }
        }
        let turned: Vector = std::array::from_fn(|i| g.constant(turned[i]));
        let back = transposed(g, 0.5, &rates, turned);
        for (found, wanted) in values(g, &back, P, RATE).into_iter().zip(RATE) {
            close(found, wanted);
        }
    }

    #[test]
    fn products_turn_one_after_the_other() {
        let g = &Builder::new();
        let angles = [0.3, -0.7, 1.9].map(|angle| g.constant(angle));
        let p = roll_pitch_yaw(g, angles);
        let r = matrix(g, p);
        let found = self::angles(g, &r);
        for (found, wanted) in g.evaluate(&found, |_| 0.0).into_iter().zip([0.3, -0.7, 1.9]) {
            close(found, wanted);
        }
        // R(z, π/2) R(x, π/2) takes z to x: first in the turned frame, −y, then turned by z.
        let right = g.constant(std::f64::consts::FRAC_PI_2);
        let (x, z) = (space::along(g, 0), space::along(g, 2));
        let (about_x, about_z) = (about(g, x, right), about(g, z, right));
        let both = product(g, about_z, about_x);
        let r = matrix(g, both);
        let column = g.evaluate(&[r[0][2], r[1][2], r[2][2]], |_| 0.0);
        close(column[0], 1.0);
        close(column[1], 0.0);
        let back = conjugate(g, both);
        let none = product(g, back, both);
        close(g.evaluate(&none, |_| 0.0)[0], 1.0);
    }
}
