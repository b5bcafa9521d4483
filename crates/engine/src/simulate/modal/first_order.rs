//! Eigenvalues where there are states: ẋ = A x with x = (p, u), positions and velocities of the motions that the
//! constraints allow, and the states among u.
//!
//! ```text
//! ṗ = u_p,   Nᵀ M N u̇ = −Nᵀ C N u − Nᵀ K N_p p
//! ```
//!
//! N are the motions that Φ_q allows, and the states. Eigenvalues are those of the strongly connected blocks of A, each
//! balanced (Parlett & Reinsch, Numer. Math. 13 (1969) 293), by real Schur decomposition: values independent of a
//! filter have no error of it. Eigenvectors come from inverse iteration.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::tuning::TUNING;
use crate::numerics::{RowSpace, combined};
use crate::simulate::statics::{Linearised, reduced};

/// An eigenvalue, or a pair of them, with its eigenvectors.
#[derive(Clone, Debug)]
pub struct Eigenvalue {
    /// λ, 1/s; of a pair the one with the positive imaginary part.
    pub value: Complex<f64>,
    /// x with A x = λ x: positions, then velocities and states, n each, per scale of the coordinates.
    pub right: Vec<Complex<f64>>,
    /// z with zᵀ A = λ zᵀ, alike.
    pub left: Vec<Complex<f64>>,
}

impl Eigenvalue {
    /// Whether it stands for two.
    pub fn is_pair(&self) -> bool {
        self.value.im > 0.0
    }

    /// The trace of the product of two spectral projectors: how many of the one's eigenvalues are the other's. It does
    /// not depend on units.
    pub fn shared(&self, other: &Self) -> f64 {
        let own = product(&self.left, &self.right) * product(&other.left, &other.right);
        let mut trace = (product(&self.left, &other.right) * product(&other.left, &self.right) / own).re;
        if self.is_pair() && other.is_pair() {
            let [left, right] =
                [&other.left, &other.right].map(|part| part.iter().map(Complex::conj).collect::<Vec<_>>());
            let own = product(&self.left, &self.right) * product(&left, &right);
            trace += (product(&self.left, &right) * product(&left, &self.right) / own).re;
        }
        let trace = if self.is_pair() || other.is_pair() { 2.0 * trace } else { trace };
        if trace.is_finite() { trace } else { 0.0 }
    }
}

/// zᵀ x
fn product(left: &[Complex<f64>], right: &[Complex<f64>]) -> Complex<f64> {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}

/// All eigenvalues about a configuration whose states are the velocities of these coordinates, the slowest first.
/// `None` where the equations have no accelerations, or the iteration does not end.
pub fn eigenvalues(linear: &Linearised, states: &[usize]) -> Option<Vec<Eigenvalue>> {
    let first_order = FirstOrder::of(linear, states)?;
    let balanced = Balanced::of(first_order.matrix.clone());
    let mut found = Vec::new();
    for block in blocks(&first_order.matrix) {
        for value in values_of_block(&first_order.matrix, &block)? {
            let [right, left] = balanced.vectors(value, &block)?;
            let [right, left] = [first_order.lifted(&right), first_order.lifted(&left)];
            found.push(Eigenvalue { value, right, left });
        }
    }
    found.sort_by(|a, b| size(a.value).total_cmp(&size(b.value)).then(a.value.re.total_cmp(&b.value.re)));
    Some(found)
}

/// |λ|
pub fn size(value: Complex<f64>) -> f64 {
    (value.re * value.re + value.im * value.im).sqrt()
}

/// A, and its unknowns.
struct FirstOrder {
    matrix: DMatrix<f64>,
    /// N, of positions first, n entries each.
    basis: Vec<Vec<f64>>,
    positions: usize,
}

impl FirstOrder {
    fn of(linear: &Linearised, states: &[usize]) -> Option<Self> {
        let n = linear.motion.len();
        let is_of_state = |vector: &Vec<f64>| states.iter().any(|&index| vector[index] != 0.0);
        let (of_states, mut basis): (Vec<_>, Vec<_>) =
            RowSpace::of(&linear.jacobian, n).null.into_iter().partition(is_of_state);
        let k = basis.len();
        basis.extend(of_states);
        let all = basis.len();
        let [mut mass, damping, stiffness] =
            [&linear.mass, &linear.damping, &linear.stiffness].map(|matrix| reduced(matrix, &basis));
        let least = TUNING.least_mass * mass.view((0, 0), (k, k)).trace();
        (0..k).for_each(|index| mass[(index, index)] += least);
        let factors = mass.lu();
        let [damping, stiffness] = [factors.solve(&damping)?, factors.solve(&stiffness)?];
        let mut matrix = DMatrix::zeros(k + all, k + all);
        for row in 0..k {
            matrix[(row, k + row)] = 1.0;
        }
        for row in 0..all {
            (0..k).for_each(|column| matrix[(k + row, column)] = -stiffness[(row, column)]);
            (0..all).for_each(|column| matrix[(k + row, k + column)] = -damping[(row, column)]);
        }
        matrix.iter().all(|value| value.is_finite()).then_some(Self { matrix, basis, positions: k })
    }

    /// Positions and velocities of all coordinates, given those along the basis.
    fn lifted(&self, vector: &[Complex<f64>]) -> Vec<Complex<f64>> {
        let n = self.basis.first().map_or(0, Vec::len);
        let (positions, velocities) = vector.split_at(self.positions);
        let mut all = Vec::with_capacity(2 * n);
        for (part, basis) in [(positions, &self.basis[..self.positions]), (velocities, &self.basis[..])] {
            let [re, im] = [|entry: &Complex<f64>| entry.re, |entry: &Complex<f64>| entry.im]
                .map(|of| combined(basis, &part.iter().map(of).collect::<Vec<f64>>(), n));
            all.extend(re.into_iter().zip(im).map(|(re, im)| Complex::new(re, im)));
        }
        all
    }
}

/// Sets of unknowns of which each depends on all others of its set.
fn blocks(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let size = matrix.nrows();
    let depends = |row: usize| (0..size).map(|column| row == column || matrix[(row, column)] != 0.0).collect();
    let mut reaches: Vec<Vec<bool>> = (0..size).map(depends).collect();
    for between in 0..size {
        let further = reaches[between].clone();
        for own in reaches.iter_mut().filter(|own| own[between]) {
            own.iter_mut().zip(&further).for_each(|(own, further)| *own |= further);
        }
    }
    let with = |index: usize| (0..size).filter(|&other| reaches[index][other] && reaches[other][index]).collect();
    let sets = (0..size).map(with);
    sets.enumerate().filter(|(index, set): &(usize, Vec<usize>)| set[0] == *index).map(|(_, set)| set).collect()
}

/// Eigenvalues of a block, one for each pair; values that are zero but for rounding are zero.
fn values_of_block(matrix: &DMatrix<f64>, block: &[usize]) -> Option<Vec<Complex<f64>>> {
    if let &[only] = block {
        return Some(vec![Complex::new(matrix[(only, only)], 0.0)]);
    }
    let mut own = DMatrix::from_fn(block.len(), block.len(), |row, column| matrix[(block[row], block[column])]);
    balance_parlett_reinsch(&mut own);
    let found = Schur::try_new(own, f64::EPSILON, 10_000)?.complex_eigenvalues();
    let largest = found.iter().fold(0.0_f64, |largest, &value| largest.max(size(value)));
    let is_still = |index: usize| {
        let value = found[index];
        let others = (0..found.len()).filter(|&other| other != index);
        let is_opposite = |other: usize| size(found[other] + value) <= TUNING.zero_of_block * largest;
        size(value) <= TUNING.zero_of_block * largest
            || size(value) <= TUNING.still_of_first_order * largest && others.into_iter().any(is_opposite)
    };
    let value = |index: usize| match found[index] {
        _ if is_still(index) => Some(Complex::new(0.0, 0.0)),
        value if value.im.abs() <= TUNING.real_eigenvalue * largest => Some(Complex::new(value.re, 0.0)),
        value => (value.im > 0.0).then_some(value),
    };
    Some((0..found.len()).filter_map(value).collect())
}

/// A with unknowns of a size in which rows and columns are about alike.
struct Balanced {
    matrix: DMatrix<f64>,
    /// d: the unknowns are d times the balanced ones.
    factors: DVector<f64>,
    rate: f64,
}

impl Balanced {
    fn of(mut matrix: DMatrix<f64>) -> Self {
        let factors = balance_parlett_reinsch(&mut matrix);
        let rate = matrix.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
        Self { matrix, factors, rate }
    }

    /// x with A x = λ x, and z with zᵀ A = λ zᵀ, of an eigenvalue of a block.
    fn vectors(&self, value: Complex<f64>, block: &[usize]) -> Option<[Vec<Complex<f64>>; 2]> {
        let off = TUNING.beside_eigenvalue * size(value).max(TUNING.beside_eigenvalue * self.rate);
        let beside = value + Complex::new(off, 0.0);
        let mut begin = vec![1e-3; self.factors.len()];
        block.iter().zip(1..).for_each(|(&index, number)| begin[index] = 1.0 + 1.0 / f64::from(number));
        let right = inverse_iteration(&self.matrix, beside, &begin)?;
        let left = inverse_iteration(&self.matrix.transpose(), beside, &begin)?;
        let right = right.iter().zip(self.factors.iter()).map(|(entry, factor)| entry * *factor).collect();
        let left = left.iter().zip(self.factors.iter()).map(|(entry, factor)| entry / *factor).collect();
        Some([right, left])
    }
}

/// The vector that A − μ makes smallest, as real equations, of twice the size where μ is not real; its largest
/// part is 1.
fn inverse_iteration(matrix: &DMatrix<f64>, near: Complex<f64>, begin: &[f64]) -> Option<Vec<Complex<f64>>> {
    let size = matrix.nrows();
    let parts = if near.im == 0.0 { 1 } else { 2 };
    let mut shifted = DMatrix::zeros(parts * size, parts * size);
    for part in 0..parts {
        shifted.view_mut((part * size, part * size), (size, size)).copy_from(matrix);
        for index in 0..size {
            let row = part * size + index;
            shifted[(row, row)] -= near.re;
            if parts == 2 {
                shifted[(row, (1 - part) * size + index)] = if part == 0 { near.im } else { -near.im };
            }
        }
    }
    let factors = shifted.lu();
    let mut vector = DVector::zeros(parts * size);
    vector.as_mut_slice()[..size].copy_from_slice(begin);
    for _ in 0..3 {
        factors.solve_mut(&mut vector).then_some(())?;
        let longest = vector.iter().fold(0.0_f64, |longest, part| longest.max(part.abs()));
        if !(longest.is_finite() && longest > 0.0) {
            return None;
        }
        vector /= longest;
    }
    let imaginary = |index: usize| if parts == 2 { vector[size + index] } else { 0.0 };
    Some((0..size).map(|index| Complex::new(vector[index], imaginary(index))).collect())
}
