//! The same scheme in a plain implementation: one sample, residual and Newton matrix by hand, full Newton with
//! nalgebra's LU.
//!
//! M w₊ + Φ_qᵀ λ₊ − Q = 0,  Φ / (βh²(1+α)) = 0,  as in `crates/equations/src/compile/newton_matrix.rs`.

use nalgebra::{DMatrix, DVector, Dyn, OMatrix, SMatrix};

const ALPHA: f64 = -0.1;

/// Last correction of positions at which Newton's iteration ends: it converges quadratically, so that the rest is
/// negligible.
const TOLERANCE: f64 = 1e-8;

const MAX_CORRECTIONS: usize = 20;

/// A planar mechanism: coordinates q, constant diagonal mass, constraints Φ.
pub trait Mechanism {
    fn mass(&self) -> &[f64];
    fn constraints(&self) -> usize;
    /// Φ(q).
    fn constraint(&self, q: &DVector<f64>, into: &mut [f64]);
    /// Φ_q at (n, 0).., its transpose, and ∂(Φ_qᵀλ)/∂q times `b` added at (0, 0)...
    fn slopes(&self, q: &DVector<f64>, lambda: &[f64], b: f64, matrix: &mut DMatrix<f64>);
    /// Q(q, v).
    fn force(&self, q: &DVector<f64>, v: &DVector<f64>, into: &mut [f64]);
    /// b ∂Q/∂q + c ∂Q/∂v, taken off the matrix.
    fn force_slopes(&self, b: f64, c: f64, matrix: &mut DMatrix<f64>);
    /// The matrix's solution; `None` if it is singular.
    fn solve(&self, matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
        matrix.clone().lu().solve(right)
    }
}

/// A state between steps.
pub struct State {
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    a: DVector<f64>,
    w: DVector<f64>,
    lambda: DVector<f64>,
}

impl State {
    /// Accelerations and multipliers consistent with positions and velocities, by a step of length zero; `curvature` is
    /// −d(Φ_q)/dt v.
    pub fn new(mechanism: &impl Mechanism, q: DVector<f64>, v: DVector<f64>, curvature: &[f64]) -> Self {
        let (n, m) = (q.len(), mechanism.constraints());
        let mut matrix = DMatrix::zeros(n + m, n + m);
        mechanism.slopes(&q, &vec![0.0; m], 0.0, &mut matrix);
        let mut right = DVector::zeros(n + m);
        mechanism.force(&q, &v, &mut right.as_mut_slice()[..n]);
        right.as_mut_slice()[n..].copy_from_slice(curvature);
        (0..n).for_each(|i| matrix[(i, i)] += mechanism.mass()[i]);
        let solution = matrix.lu().solve(&right).expect("the start is not singular");
        let w = solution.rows(0, n).into_owned();
        Self { q, v, a: w.clone(), w, lambda: solution.rows(n, m).into_owned() }
    }
}

/// Steps of length h.
pub fn advance(mechanism: &impl Mechanism, state: &mut State, h: f64, steps: usize) {
    let (n, m) = (state.q.len(), mechanism.constraints());
    let (beta, gamma) = ((1.0 - ALPHA) * (1.0 - ALPHA) / 4.0, 0.5 - ALPHA);
    let (b, c) = (beta * h * h * (1.0 + ALPHA), gamma * h * (1.0 + ALPHA));
    let mut matrix = DMatrix::zeros(n + m, n + m);
    let mut right = DVector::zeros(n + m);
    for _ in 0..steps {
        let known_q = &state.q + &state.v * h + (&state.a * (0.5 - beta) - &state.w * (beta * ALPHA)) * (h * h);
        let known_v = &state.v + (&state.a * (1.0 - gamma) - &state.w * (gamma * ALPHA)) * h;
        let mut w = state.w.clone();
        for count in 0.. {
            assert!(count < MAX_CORRECTIONS, "Newton's iteration does not converge");
            let q = &known_q + &w * b;
            let v = &known_v + &w * c;
            matrix.fill(0.0);
            mechanism.slopes(&q, state.lambda.as_slice(), b, &mut matrix);
            let (motion, closure) = right.as_mut_slice().split_at_mut(n);
            mechanism.force(&q, &v, motion);
            mechanism.constraint(&q, closure);
            closure.iter_mut().for_each(|gap| *gap /= -b);
            // Φ_qᵀ λ, from the matrix's own block.
            for (k, &pull) in state.lambda.iter().enumerate() {
                let column = matrix.column(n + k);
                motion.iter_mut().zip(column.iter()).for_each(|(force, slope)| *force -= slope * pull);
            }
            for i in 0..n {
                motion[i] -= mechanism.mass()[i] * w[i];
                matrix[(i, i)] += mechanism.mass()[i];
            }
            mechanism.force_slopes(b, c, &mut matrix);
            let correction = mechanism.solve(&matrix, &right).expect("the matrix is not singular");
            w += correction.rows(0, n);
            state.lambda += correction.rows(n, m);
            if b * correction.rows(0, n).amax() < TOLERANCE {
                break;
            }
        }
        state.q = known_q + &w * b;
        state.v = known_v + &w * c;
        state.a = &w * (1.0 + ALPHA) - &state.w * ALPHA;
        state.w = w;
    }
}

/// A pin between two bodies (`None`: the ground), at points of their frames.
struct Pin {
    ends: [(Option<usize>, [f64; 2]); 2],
}

/// Bodies with x, y and an angle each, and pins.
pub struct Bars {
    mass: Vec<f64>,
    pins: Vec<Pin>,
    gravity: f64,
}

impl Bars {
    /// The N-four-bar, and its start: (q, v, −d(Φ_q)/dt v).
    pub fn four_bar(loops: usize) -> (Self, State) {
        let link = |i: usize| loops + 1 + i;
        let (low, high, left, right) = ([0.0, -0.5], [0.0, 0.5], [-0.5, 0.0], [0.5, 0.0]);
        let mut pins: Vec<Pin> = (0..=loops).map(|i| Pin { ends: [(None, [i as f64, 0.0]), (Some(i), low)] }).collect();
        for i in 0..loops {
            pins.push(Pin { ends: [(Some(i), high), (Some(link(i)), left)] });
            pins.push(Pin { ends: [(Some(link(i)), right), (Some(i + 1), high)] });
        }
        let (mut q, mut v) = (Vec::new(), Vec::new());
        (0..=loops).for_each(|i| q.extend([i as f64, 0.5, 0.0]));
        (0..loops).for_each(|i| q.extend([i as f64 + 0.5, 1.0, 0.0]));
        (0..=loops).for_each(|_| v.extend([0.5, 0.0, -1.0]));
        (0..loops).for_each(|_| v.extend([1.0, 0.0, 0.0]));
        let mass = (0..2 * loops + 1).flat_map(|_| [1.0, 1.0, 1.0 / 12.0]).collect();
        let bars = Self { mass, pins, gravity: 9.81 };
        let (q, v) = (DVector::from_vec(q), DVector::from_vec(v));
        let mut curvature = Vec::new();
        for pin in &bars.pins {
            let [first, second] = pin.ends.map(|(body, point)| match body {
                Some(i) => rotated(q[3 * i + 2], point).map(|r| r * v[3 * i + 2] * v[3 * i + 2]),
                None => [0.0; 2],
            });
            curvature.extend([first[0] - second[0], first[1] - second[1]]);
        }
        let state = State::new(&bars, q, v, &curvature);
        (bars, state)
    }
}

fn rotated(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

impl Mechanism for Bars {
    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn constraints(&self) -> usize {
        2 * self.pins.len()
    }

    fn constraint(&self, q: &DVector<f64>, into: &mut [f64]) {
        for (pin, gap) in self.pins.iter().zip(into.chunks_exact_mut(2)) {
            let [first, second] = pin.ends.map(|(body, point)| match body {
                Some(i) => {
                    let r = rotated(q[3 * i + 2], point);
                    [q[3 * i] + r[0], q[3 * i + 1] + r[1]]
                }
                None => point,
            });
            gap.copy_from_slice(&[first[0] - second[0], first[1] - second[1]]);
        }
    }

    fn slopes(&self, q: &DVector<f64>, lambda: &[f64], b: f64, matrix: &mut DMatrix<f64>) {
        let n = q.len();
        for (k, pin) in self.pins.iter().enumerate() {
            let row = n + 2 * k;
            for ((body, point), sign) in pin.ends.iter().zip([1.0, -1.0]) {
                let Some(i) = body else { continue };
                let r = rotated(q[3 * i + 2], *point);
                for (line, column, value) in
                    [(row, 3 * i, 1.0), (row + 1, 3 * i + 1, 1.0), (row, 3 * i + 2, -r[1]), (row + 1, 3 * i + 2, r[0])]
                {
                    matrix[(line, column)] = sign * value;
                    matrix[(column, line)] = sign * value;
                }
                matrix[(3 * i + 2, 3 * i + 2)] -= b * sign * (r[0] * lambda[2 * k] + r[1] * lambda[2 * k + 1]);
            }
        }
    }

    fn force(&self, _: &DVector<f64>, _: &DVector<f64>, into: &mut [f64]) {
        for (force, mass) in into.chunks_exact_mut(3).zip(self.mass.chunks_exact(3)) {
            force.copy_from_slice(&[0.0, -self.gravity * mass[1], 0.0]);
        }
    }

    fn force_slopes(&self, _: f64, _: f64, _: &mut DMatrix<f64>) {}
}

/// The slider crank of Wu, Luo & Zhang, at its nominal parameters.
pub struct SliderCrank {
    mass: [f64; 7],
}

const L1: f64 = 0.15;
const L2: f64 = 0.56;
const STIFFNESS: f64 = 5.0;
const DAMPING: f64 = 1.0;
const TORQUE: f64 = -0.5;

impl SliderCrank {
    /// The straight position, at rest.
    pub fn start() -> (Self, State) {
        let (m1, m2, m3) = (0.37, 0.77, 0.45);
        let crank = Self { mass: [m1, m1, m1 * L1 * L1 / 12.0, m2, m2, m2 * L2 * L2 / 12.0, m3] };
        let q = DVector::from_column_slice(&[L1 / 2.0, 0.0, 0.0, L1 + L2 / 2.0, 0.0, 0.0, L1 + L2]);
        let state = State::new(&crank, q, DVector::zeros(7), &[0.0; 6]);
        (crank, state)
    }
}

impl Mechanism for SliderCrank {
    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn constraints(&self) -> usize {
        6
    }

    fn constraint(&self, q: &DVector<f64>, into: &mut [f64]) {
        let ((s1, c1), (s2, c2)) = (q[2].sin_cos(), q[5].sin_cos());
        into.copy_from_slice(&[
            q[0] - L1 / 2.0 * c1,
            q[1] - L1 / 2.0 * s1,
            q[0] + L1 / 2.0 * c1 - q[3] + L2 / 2.0 * c2,
            q[1] + L1 / 2.0 * s1 - q[4] + L2 / 2.0 * s2,
            q[3] + L2 / 2.0 * c2 - q[6],
            q[4] + L2 / 2.0 * s2,
        ]);
    }

    fn slopes(&self, q: &DVector<f64>, lambda: &[f64], b: f64, matrix: &mut DMatrix<f64>) {
        let ((s1, c1), (s2, c2)) = (q[2].sin_cos(), q[5].sin_cos());
        let (r1, r2) = (L1 / 2.0, L2 / 2.0);
        let entries = [
            (0, 0, 1.0),
            (0, 2, r1 * s1),
            (1, 1, 1.0),
            (1, 2, -r1 * c1),
            (2, 0, 1.0),
            (2, 2, -r1 * s1),
            (2, 3, -1.0),
            (2, 5, -r2 * s2),
            (3, 1, 1.0),
            (3, 2, r1 * c1),
            (3, 4, -1.0),
            (3, 5, r2 * c2),
            (4, 3, 1.0),
            (4, 5, -r2 * s2),
            (4, 6, -1.0),
            (5, 4, 1.0),
            (5, 5, r2 * c2),
        ];
        for (row, column, value) in entries {
            matrix[(7 + row, column)] = value;
            matrix[(column, 7 + row)] = value;
        }
        matrix[(2, 2)] += b * r1 * (c1 * (lambda[0] - lambda[2]) + s1 * (lambda[1] - lambda[3]));
        matrix[(5, 5)] -= b * r2 * (c2 * (lambda[2] + lambda[4]) + s2 * (lambda[3] + lambda[5]));
    }

    fn force(&self, q: &DVector<f64>, v: &DVector<f64>, into: &mut [f64]) {
        into.copy_from_slice(&[0.0, 0.0, TORQUE, 0.0, 0.0, 0.0, -STIFFNESS * (q[6] - L1 - L2) - DAMPING * v[6]]);
    }

    fn force_slopes(&self, b: f64, c: f64, matrix: &mut DMatrix<f64>) {
        matrix[(6, 6)] += b * STIFFNESS + c * DAMPING;
    }

    /// Sizes known at compile time are a little faster.
    fn solve(&self, matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
        let matrix = SMatrix::<f64, 13, 13>::from_column_slice(matrix.as_slice());
        let solution = matrix.lu().solve(&SMatrix::<f64, 13, 1>::from_column_slice(right.as_slice()))?;
        Some(OMatrix::<f64, Dyn, nalgebra::U1>::from_column_slice(solution.as_slice()))
    }
}
