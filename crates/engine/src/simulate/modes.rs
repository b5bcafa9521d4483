//! Fast modes that the start or something later excites and that the scheme damps: with steps of any size that are long
//! for them, it damps them alike, so that halving the steps does not show this damping.
//!
//! About the nominal start the equations of motion are M δẅ + C δv + K δq + Φ_qᵀ δλ = 0 with Φ_q δq = 0. A mode φ (φᵀMφ
//! = 1, frequency ω) has the amplitude √((φᵀMw/ω²)² + (φᵀMv/ω)²): slow modes have hardly any part in φᵀMw/ω².

use nalgebra::{Complex, DMatrix, DVector, Dyn, Matrix3, SVD, SymmetricEigen, Vector3};
use symdiff::{Expr, math, slopes};

use super::control::Schedule;
use super::excitations::{Excitation, WatchedMode, excitations};
use super::fast_states::{StateMode, of_states};
use super::simulator::Simulator;
use super::tuning::TUNING;
use crate::compile::{Coefficients, equations_of_motion};

/// A mode that the start or something later excites.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitedMode {
    /// ω, rad/s.
    pub frequency: f64,
    /// Its own decay, 1/s.
    pub decay: f64,
    /// Its decay by the scheme with these steps and with halved ones, 1/s.
    pub by_scheme: [f64; 2],
    /// Its excitations.
    pub excitations: Vec<Excitation>,
    /// Amplitude of each output for an amplitude of 1, in the output's unit.
    pub in_outputs: Vec<f64>,
}

impl ExcitedMode {
    /// Amplitude in an output lost by damping of the steps up to a time, relative to the rest, that halving them does
    /// not show (halving shows 4/3 of the difference).
    pub fn lost(&self, output: usize, time: f64) -> f64 {
        let of_one = |excitation: &Excitation| {
            let since = time - excitation.time;
            let left = math::exp(-self.decay * since);
            let [whole, halved] = self.by_scheme.map(|decay| 1.0 - math::exp(-decay * since));
            excitation.amplitude * left * ((4.0 * halved - whole) / 3.0).max(0.0)
        };
        let begun = self.excitations.iter().filter(|excitation| excitation.time <= time);
        self.in_outputs[output] * begun.map(of_one).sum::<f64>()
    }
}

/// The modes of a mechanism about its nominal start that the steps of a schedule damp, the fastest last, with their
/// excitations.
pub fn excited_modes(simulator: &Simulator, schedule: &Schedule) -> Vec<ExcitedMode> {
    let n = simulator.system.q.len();
    if n > TUNING.most_coordinates {
        return Vec::new();
    }
    let linear = Linearised::at_start(simulator);
    let (mut modes, watched): (Vec<ExcitedMode>, Vec<WatchedMode>) =
        linear.modes(simulator, schedule.longest_step()).into_iter().unzip();
    let slower = modes.len().saturating_sub(TUNING.most_watched);
    if !watched.is_empty() {
        let later = excitations(simulator, schedule, &watched[slower..], TUNING.slowest_watched);
        modes[slower..].iter_mut().zip(later).for_each(|(mode, later)| mode.excitations.extend(later));
    }
    modes
}

/// The equations about the nominal start.
struct Linearised {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// Φ_q, and Ψ_v below it.
    constraint: DMatrix<f64>,
    velocity: DVector<f64>,
    acceleration: DVector<f64>,
    /// Derivatives of the outputs by q, v, w and λ.
    outputs: [DMatrix<f64>; 4],
    /// Indices of the coordinates whose velocities are states.
    states: Vec<usize>,
}

impl Linearised {
    fn at_start(simulator: &Simulator) -> Self {
        let (system, layout) = (&simulator.system, &simulator.program.layout);
        let mut graph = system.graph.clone();
        let (motion, constraint) = equations_of_motion(system, &mut graph);
        let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
        let registers =
            [(&system.q, &layout.q), (&system.v, &layout.v), (&system.w, &layout.w), (&system.lambda, &layout.lambda)];
        let mut values = rustc_hash::FxHashMap::default();
        for (symbols, registers) in registers {
            values.extend(symbols.iter().copied().zip(registers.clone().map(|register| simulator.nominal[register])));
        }
        for parameter in &system.parameters {
            values.insert(parameter.symbol, parameter.nominal);
        }
        // The time is zero.
        let number = |expr: Expr| values.get(&expr).copied().unwrap_or(0.0);
        let by = [&system.q, &system.v, &system.w, &system.lambda].map(Vec::as_slice);
        let all = by.concat();
        let derivatives = |of: &[Expr]| {
            let rows = slopes(&graph, of, &all, number);
            let mut first = 0;
            by.map(|by| {
                first += by.len();
                DMatrix::from_fn(of.len(), by.len(), |row, column| rows[row][first - by.len() + column])
            })
        };
        let mut jacobian = DMatrix::zeros(system.lambda.len(), system.q.len());
        let entries: Vec<(usize, usize, Expr)> = constraint.entries().collect();
        let values: Vec<Expr> = entries.iter().map(|&(_, _, value)| value).collect();
        for (&(row, column, _), value) in entries.iter().zip(graph.evaluate(&values, number)) {
            jacobian[(row, column)] = value;
        }
        let vector =
            |registers: &std::ops::Range<usize>| DVector::from_column_slice(&simulator.nominal[registers.clone()]);
        let [stiffness, damping, mass, _] = derivatives(&motion);
        Self {
            mass,
            damping,
            stiffness,
            constraint: jacobian,
            velocity: vector(&layout.v),
            acceleration: vector(&layout.w),
            outputs: derivatives(&outputs),
            states: (0..system.q.len()).filter(|&index| system.coordinates[index].is_state).collect(),
        }
    }

    /// Modes of the mechanism with constant states, and those of the states with constant positions and velocities:
    /// together their equations have no symmetric matrices.
    fn modes(&self, simulator: &Simulator, h: f64) -> Vec<(ExcitedMode, WatchedMode)> {
        let mut modes = self.modes_of_mechanism(simulator, h).unwrap_or_default();
        modes.extend(self.modes_of_states(simulator, h));
        modes.sort_by(|(a, _), (b, _)| a.frequency.total_cmp(&b.frequency));
        modes
    }

    fn modes_of_states(&self, simulator: &Simulator, h: f64) -> Vec<(ExcitedMode, WatchedMode)> {
        let count = self.states.len();
        let block = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(count, count, |row, column| matrix[(self.states[row], self.states[column])])
        };
        let rates: Vec<f64> = self.states.iter().map(|&index| self.acceleration[index]).collect();
        let found = if count > 0 { of_states(block(&self.mass), block(&self.damping), &rates) } else { Vec::new() };
        let size = |value: Complex<f64>| math::hypot(value.re, value.im);
        let [_, by_v, by_w, _] = &self.outputs;
        let of_mode = |mode: StateMode| {
            let of_output = |output: usize| {
                let by = |(&index, &shape): (&usize, &Complex<f64>)| {
                    shape * (mode.value * by_w[(output, index)] + by_v[(output, index)])
                };
                size(self.states.iter().zip(&mode.shape).map(by).sum())
            };
            let frequency = size(mode.value);
            let excited = ExcitedMode {
                frequency,
                decay: (-mode.value.re).clamp(0.0, frequency),
                by_scheme: by_scheme(h, frequency, simulator.program.coefficients),
                excitations: vec![Excitation { time: 0.0, amplitude: mode.amplitude }],
                in_outputs: (0..by_v.nrows()).map(of_output).collect(),
            };
            (excited, WatchedMode { weighted: vec![0.0; self.mass.nrows()], frequency })
        };
        found.into_iter().filter(|mode| size(mode.value) * h > TUNING.slowest_watched).map(of_mode).collect()
    }

    /// `None` where M is not positive on the motions that the constraints allow.
    fn modes_of_mechanism(&self, simulator: &Simulator, h: f64) -> Option<Vec<(ExcitedMode, WatchedMode)>> {
        let allowed = self.allowed_motions()?;
        let on_allowed = |matrix: &DMatrix<f64>| allowed.transpose() * matrix * &allowed;
        let symmetric = |matrix: DMatrix<f64>| (&matrix + matrix.transpose()) * 0.5;
        let root = symmetric(on_allowed(&self.mass)).cholesky()?;
        let half = root.l().solve_lower_triangular(&symmetric(on_allowed(&self.stiffness)))?;
        let scaled = symmetric(root.l().solve_lower_triangular(&half.transpose())?);
        if scaled.iter().any(|value| !value.is_finite()) {
            return None;
        }
        // No eigenvalue is larger than the largest sum of a row.
        let largest = scaled.row_iter().map(|row| row.iter().map(|value| value.abs()).sum()).fold(0.0, f64::max);
        if largest.sqrt() * h <= TUNING.slowest_watched {
            return Some(Vec::new());
        }
        let eigen = SymmetricEigen::new(scaled);
        let shapes = &allowed * root.l().transpose().solve_upper_triangular(&eigen.eigenvectors)?;
        let [.., by_lambda] = &self.outputs;
        let reactions_matter = by_lambda.iter().any(|&value| value != 0.0);
        let constraints =
            (reactions_matter && self.constraint.nrows() > 0).then(|| self.constraint.transpose().svd(true, true));
        let mut modes = Vec::new();
        for (index, &square) in eigen.eigenvalues.iter().enumerate() {
            if square.sqrt() * h > TUNING.slowest_watched {
                let shape = shapes.column(index).into_owned();
                let coefficients = simulator.program.coefficients;
                modes.push(self.mode(&shape, square.sqrt(), h, coefficients, constraints.as_ref()));
            }
        }
        Some(modes)
    }

    fn mode(
        &self,
        shape: &DVector<f64>,
        omega: f64,
        h: f64,
        coefficients: Coefficients,
        constraints: Option<&SVD<f64, Dyn, Dyn>>,
    ) -> (ExcitedMode, WatchedMode) {
        let weighted = &self.mass * shape;
        let by_acceleration = weighted.dot(&self.acceleration) / (omega * omega);
        let amplitude = math::hypot(by_acceleration, weighted.dot(&self.velocity) / omega);
        // The constraints' forces hold the rest of (K − ω² M) φ.
        let rest = (&self.stiffness * shape - &weighted * (omega * omega)) * -1.0;
        let m = self.constraint.nrows();
        let reactions = constraints.and_then(|svd| svd.solve(&rest, 1e-12).ok()).unwrap_or_else(|| DVector::zeros(m));
        let [by_q, by_v, by_w, by_lambda] = &self.outputs;
        let parts = [by_q * shape, by_v * shape * omega, by_w * shape * (omega * omega), by_lambda * reactions];
        // Displacements, accelerations and reactions are in phase, velocities a quarter behind.
        let in_phase = &parts[0] - &parts[2] + &parts[3];
        let in_outputs = in_phase.iter().zip(parts[1].iter()).map(|(a, b)| math::hypot(*a, *b)).collect();
        let decay = (0.5 * shape.dot(&(&self.damping * shape))).clamp(0.0, omega);
        let mode = ExcitedMode {
            frequency: omega,
            decay,
            by_scheme: by_scheme(h, omega, coefficients),
            excitations: vec![Excitation { time: 0.0, amplitude }],
            in_outputs,
        };
        (mode, WatchedMode { weighted: weighted.iter().copied().collect(), frequency: omega })
    }

    /// A basis of the motions with Φ_q δq = 0 of which no state is a part: columns.
    fn allowed_motions(&self) -> Option<DMatrix<f64>> {
        let n = self.mass.nrows();
        if self.constraint.nrows() == 0 && self.states.is_empty() {
            return Some(DMatrix::identity(n, n));
        }
        let mut normal = self.constraint.transpose() * &self.constraint;
        let held = normal.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
        self.states.iter().for_each(|&index| normal[(index, index)] += held);
        if normal.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(normal);
        let largest = eigen.eigenvalues.max();
        let columns: Vec<DVector<f64>> = (0..n)
            .filter(|&index| eigen.eigenvalues[index] <= TUNING.allowed_motion * largest)
            .map(|index| eigen.eigenvectors.column(index).into_owned())
            .collect();
        (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
    }
}

/// Decay of a mode by the scheme with steps of `h`, and with halved ones, 1/s.
fn by_scheme(h: f64, frequency: f64, coefficients: Coefficients) -> [f64; 2] {
    [h, 0.5 * h].map(|h| decay_by_scheme(coefficients, h * frequency) / h)
}

/// Decrease of the logarithm of the amplitude of q̈ + q = 0 in a step of the scheme whose length is `step`: from the
/// spectral radius of its matrix in (q, v, a), since w = −q.
fn decay_by_scheme(coefficients: Coefficients, step: f64) -> f64 {
    let Coefficients { beta, gamma, .. } = coefficients;
    let (of_new, of_old, of_algorithmic) =
        (coefficients.of_new(), coefficients.of_old(), coefficients.of_algorithmic());
    let gain = beta * step * step * of_new;
    let advance = |[q, v, a]: [f64; 3]| {
        let known = -of_old * q - of_algorithmic * a;
        let q_known = q + step * v + step * step * ((0.5 - beta) * a + beta * known);
        let v_known = v + step * ((1.0 - gamma) * a + gamma * known);
        let new = -q_known / (1.0 + gain);
        Vector3::new(-new, v_known + gamma * step * of_new * new, of_new * new + known)
    };
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(advance);
    let radius = Matrix3::from_columns(&columns)
        .complex_eigenvalues()
        .iter()
        .map(|root| (root.re * root.re + root.im * root.im).sqrt())
        .fold(0.0, f64::max);
    (-std::f64::consts::LN_2 * math::log2(radius)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::Scheme;

    #[test]
    fn damping_of_fast_modes_equals_the_spectral_radius() {
        for alpha in [-0.05, -0.1, -0.3] {
            let scheme = Scheme::Hht { alpha };
            let radius = math::exp(-decay_by_scheme(scheme.coefficients(), 1e4));
            assert!((radius - scheme.spectral_radius()).abs() < 1e-3, "{alpha}: {radius}");
        }
    }

    #[test]
    fn slow_waves_are_hardly_damped() {
        // The damping ratio is of third order.
        let decay = |step: f64| decay_by_scheme(Scheme::Hht { alpha: -0.1 }.coefficients(), step);
        assert!((decay(0.1) / decay(0.05) - 16.0).abs() < 1.0, "{} {}", decay(0.1), decay(0.05));
        assert!(decay(0.1) < 1e-5);
        assert_eq!(decay_by_scheme(Scheme::TrapezoidalIndex2.coefficients(), 3.0).max(1e-9), 1e-9);
    }
}
