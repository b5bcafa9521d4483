//! Frequencies, damping ratios and shapes: (λ² M + λ C + K) φ = 0 on the motions that the constraints allow.
//!
//! Without damping that is a symmetric problem. Else the eigenvalues are those of [0 I; −M⁻¹K −M⁻¹C], by real Schur
//! decomposition, and the shapes come from inverse iteration. A pair σ ± iω is a mode of frequency |λ| and damping
//! ratio −σ/|λ|; two real eigenvalues λ₁, λ₂ are one of √(λ₁λ₂) and −(λ₁ + λ₂)/(2√(λ₁λ₂)), so that both go on smoothly
//! where damping becomes critical.

use nalgebra::{DMatrix, DVector, Schur, SymmetricEigen};

use super::tuning::TUNING;
use crate::numerics::{RowSpace, combined};
use crate::simulate::statics::{Linearised, reduced};

/// A mode; shapes are per scale of the coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Undamped natural frequency |λ|, rad/s; negative where the mode grows without vibrating.
    pub frequency: f64,
    /// Damping ratio; NaN without a frequency.
    pub damping: f64,
    /// Real and imaginary part of the shape, n each.
    pub shape: [Vec<f64>; 2],
}

/// The equations on the motions that the constraints allow.
struct Reduced {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    basis: Vec<Vec<f64>>,
}

/// All modes of a configuration, the slowest first. `None` where M is not positive there, or the iteration does not
/// end.
pub fn modes(linear: &Linearised) -> Option<Vec<Mode>> {
    let basis = RowSpace::of(&linear.jacobian, linear.motion.len()).null;
    if basis.is_empty() {
        return Some(Vec::new());
    }
    let [mut mass, damping, stiffness] =
        [&linear.mass, &linear.damping, &linear.stiffness].map(|matrix| reduced(matrix, &basis));
    let least = TUNING.least_mass * mass.trace();
    (0..basis.len()).for_each(|place| mass[(place, place)] += least);
    let reduced = Reduced { mass: symmetric(&mass), damping, stiffness, basis };
    let undamped = reduced.undamped()?;
    let mut modes = if reduced.is_undamped() { undamped } else { reduced.damped(&undamped)? };
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    Some(modes)
}

fn symmetric(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}

fn size(matrix: &DMatrix<f64>) -> f64 {
    matrix.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

/// √|square| with the sign of the square.
fn signed_root(square: f64) -> f64 {
    square.abs().sqrt() * if square < 0.0 { -1.0 } else { 1.0 }
}

impl Reduced {
    fn is_undamped(&self) -> bool {
        let frequency = (size(&self.stiffness) * size(&self.mass)).sqrt();
        let skew = size(&(&self.stiffness - self.stiffness.transpose()));
        size(&self.damping) <= TUNING.no_damping * frequency && skew <= TUNING.no_damping * size(&self.stiffness)
    }

    fn lifted(&self, part: &[f64]) -> Vec<f64> {
        combined(&self.basis, part, self.basis[0].len())
    }

    /// Modes of the symmetric part of K, without damping.
    fn undamped(&self) -> Option<Vec<Mode>> {
        let root = self.mass.clone().cholesky()?.unpack();
        let half = root.solve_lower_triangular(&symmetric(&self.stiffness))?;
        let scaled = symmetric(&root.solve_lower_triangular(&half.transpose())?);
        if scaled.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(scaled);
        let shapes = root.tr_solve_lower_triangular(&eigen.eigenvectors)?;
        let largest = eigen.eigenvalues.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let mode = |index: usize| {
            let square = eigen.eigenvalues[index];
            let is_still = square.abs() <= TUNING.still_of_second_order * TUNING.still_of_second_order * largest;
            let part: Vec<f64> = shapes.column(index).iter().copied().collect();
            Mode {
                frequency: if is_still { 0.0 } else { signed_root(square) },
                damping: if is_still { f64::NAN } else { 0.0 },
                shape: [self.lifted(&part), vec![0.0; self.basis[0].len()]],
            }
        };
        let mut modes: Vec<Mode> = (0..self.basis.len()).map(mode).collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        Some(modes)
    }

    fn damped(&self, undamped: &[Mode]) -> Option<Vec<Mode>> {
        let k = self.basis.len();
        let factors = self.mass.clone().cholesky()?;
        let (stiffness, damping) = (factors.solve(&self.stiffness), factors.solve(&self.damping));
        // In a time in which stiffness and damping are about one, the matrix is balanced.
        let rate = size(&stiffness).sqrt().max(size(&damping)).max(f64::MIN_POSITIVE);
        let mut matrix = DMatrix::zeros(2 * k, 2 * k);
        for row in 0..k {
            matrix[(row, k + row)] = 1.0;
            for column in 0..k {
                matrix[(k + row, column)] = -stiffness[(row, column)] / (rate * rate);
                matrix[(k + row, k + column)] = -damping[(row, column)] / rate;
            }
        }
        if matrix.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let found = Schur::try_new(matrix, f64::EPSILON, 10_000)?.complex_eigenvalues();
        let mut pairs: Vec<[f64; 2]> = Vec::new();
        let mut real: Vec<f64> = Vec::new();
        for value in found.iter().map(|value| [value.re * rate, value.im * rate]) {
            if value[1].abs() <= TUNING.still_of_second_order * TUNING.still_of_second_order * rate {
                real.push(value[0]);
            } else if value[1] > 0.0 {
                pairs.push(value);
            }
        }
        pairs.sort_by(|a, b| (a[1], a[0]).partial_cmp(&(b[1], b[0])).unwrap_or(std::cmp::Ordering::Equal));
        real.sort_by(f64::total_cmp);
        let mut modes = Vec::with_capacity(k);
        for (index, &[re, im]) in pairs.iter().enumerate() {
            let frequency = (re * re + im * im).sqrt();
            let shape = self.shape([re, im], &undamped[index % undamped.len()])?;
            modes.push(Mode { frequency, damping: -re / frequency, shape });
        }
        modes.extend(self.of_real(&real, rate, undamped)?);
        Some(modes)
    }

    /// Real eigenvalues, two by two: the fastest with the slowest decay that has the most similar shape.
    fn of_real(&self, values: &[f64], rate: f64, undamped: &[Mode]) -> Option<Vec<Mode>> {
        let mut open: Vec<(f64, [Vec<f64>; 2])> = Vec::with_capacity(values.len());
        for (index, &value) in values.iter().enumerate() {
            open.push((value, self.shape([value, 0.0], &undamped[index % undamped.len()])?));
        }
        let mut modes = Vec::new();
        while open.len() > 1 {
            let (fast, shape) = open.remove(0);
            let likeness = |other: &(f64, [Vec<f64>; 2])| super::likeness::likeness(&shape, &other.1, None);
            let partner =
                (0..open.len()).reduce(|a, b| if likeness(&open[b]) >= likeness(&open[a]) { b } else { a })?;
            let (slow, shape) = open.remove(partner);
            let product = fast * slow;
            let is_still = fast.abs().min(slow.abs()) <= TUNING.still_of_second_order * rate;
            let frequency = if is_still { 0.0 } else { signed_root(product) };
            let damping = if is_still || product < 0.0 { f64::NAN } else { -(fast + slow) / (2.0 * frequency) };
            modes.push(Mode { frequency, damping, shape });
        }
        Some(modes)
    }

    /// By inverse iteration with P(λ) = λ² M + λ C + K near the eigenvalue, as real equations of twice the size.
    fn shape(&self, [re, im]: [f64; 2], begin: &Mode) -> Option<[Vec<f64>; 2]> {
        let k = self.basis.len();
        let off = TUNING.beside_eigenvalue
            * (re * re + im * im).sqrt().max(TUNING.beside_eigenvalue * size(&self.stiffness).sqrt());
        let re = re + off;
        let (square_re, square_im) = (re * re - im * im, 2.0 * re * im);
        let mut matrix = DMatrix::zeros(2 * k, 2 * k);
        for (row, column) in (0..k).flat_map(|row| (0..k).map(move |column| (row, column))) {
            let [m, c, s] = [&self.mass, &self.damping, &self.stiffness].map(|matrix| matrix[(row, column)]);
            let (real, imaginary) = (square_re * m + re * c + s, square_im * m + im * c);
            matrix[(row, column)] = real;
            matrix[(k + row, k + column)] = real;
            matrix[(row, k + column)] = -imaginary;
            matrix[(k + row, column)] = imaginary;
        }
        let factors = matrix.lu();
        let mut shape = DVector::zeros(2 * k);
        for (index, vector) in self.basis.iter().enumerate() {
            shape[index] = crate::numerics::dot(vector, &begin.shape[0]) + 1e-3 / (1.0 + index as f64);
        }
        for _ in 0..3 {
            factors.solve_mut(&mut shape).then_some(())?;
            let longest = shape.iter().fold(0.0_f64, |longest, part| longest.max(part.abs()));
            if !(longest.is_finite() && longest > 0.0) {
                return None;
            }
            shape /= longest;
        }
        let parts = shape.as_slice();
        Some([self.lifted(&parts[..k]), self.lifted(&parts[k..])])
    }
}
