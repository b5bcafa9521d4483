//! Stability of an equilibrium: the smallest eigenvalue of K on the motions that the constraints allow, about M there.

use nalgebra::{DMatrix, SymmetricEigen};

use super::configuration::{Linearised, reduced};
use super::tuning::TUNING;
use crate::assemble::CoordinateId;
use crate::numerics::RowSpace;
use crate::simulate::modal::tuning::TUNING as MODAL;

/// Stability of an equilibrium by its stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// The smallest eigenvalue of K φ = ω² M φ, rad²/s²: negative where the equilibrium is unstable; infinite where
    /// nothing can move.
    pub smallest: f64,
    /// The coordinates that move most in directions without stiffness.
    pub indifferent: Vec<CoordinateId>,
}

impl Stability {
    /// By the symmetric part of K: loads that follow the motion do work of their own, which is no stiffness.
    pub fn of(linear: &Linearised) -> Self {
        let space = RowSpace::of(&linear.jacobian, linear.motion.len());
        if space.null.is_empty() {
            return Self { smallest: f64::INFINITY, indifferent: Vec::new() };
        }
        let Some((values, vectors)) = eigen(&linear.stiffness, &linear.mass, &space.null) else {
            return Self { smallest: f64::NAN, indifferent: Vec::new() };
        };
        let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let is_none = |value: &f64| value.abs() <= TUNING.indifferent_eigenvalue * largest;
        let mut indifferent: Vec<CoordinateId> = (0..values.len())
            .filter(|&index| is_none(&values[index]))
            .filter_map(|index| {
                let shape = &vectors[index];
                (0..shape.len()).max_by(|&a, &b| shape[a].abs().total_cmp(&shape[b].abs()))
            })
            .map(CoordinateId::new)
            .collect();
        indifferent.sort_unstable();
        indifferent.dedup();
        Self { smallest: values.iter().copied().fold(f64::INFINITY, f64::min), indifferent }
    }
}

/// Eigenvalues of K φ = ω² M φ for the symmetric parts on a basis, and the shapes (n each) with φᵀ M φ = 1. `None`
/// where a number is not finite.
fn eigen(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>, basis: &[Vec<f64>]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let symmetric = |matrix: DMatrix<f64>| (&matrix + matrix.transpose()) * 0.5;
    let (stiffness, mut mass) = (symmetric(reduced(stiffness, basis)), symmetric(reduced(mass, basis)));
    let least = MODAL.least_mass * mass.trace();
    (0..basis.len()).for_each(|index| mass[(index, index)] += least);
    let root = mass.cholesky()?.unpack();
    let half = root.solve_lower_triangular(&stiffness)?;
    let scaled = symmetric(root.solve_lower_triangular(&half.transpose())?);
    if scaled.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::new(scaled);
    let shapes = root.tr_solve_lower_triangular(&eigen.eigenvectors)?;
    let n = basis[0].len();
    let shape = |column: usize| {
        let part: Vec<f64> = shapes.column(column).iter().copied().collect();
        crate::numerics::combined(basis, &part, n)
    };
    Some((eigen.eigenvalues.iter().copied().collect(), (0..basis.len()).map(shape).collect()))
}
