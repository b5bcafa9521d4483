//! Shares of the parameters in the variance of a polynomial, every parameter spread evenly over its interval.
//!
//! In products of orthonormal Legendre polynomials the variance is the sum of the squares of all coefficients but the
//! constant's, and the terms in which a parameter occurs, alone or with others, are its part (Sobol 1993; Sudret 2008).
//! Chebyshev polynomials are turned into Legendre's along one axis after the other, exactly: degrees only go down, so
//! terms suffice.

use super::sparse_basis::SparseBasis;
use super::tensor::Matrix;

/// Sobol indices of the parameters: shares in the variance.
#[derive(Clone, Debug, PartialEq)]
pub struct SobolIndices {
    /// Index of each parameter alone.
    pub main: Vec<f64>,
    /// Index of each parameter, alone and together with others.
    pub total: Vec<f64>,
    /// Share of parameters together: 1 − Σ main.
    interactions: f64,
}

/// Computes shares for polynomials of one basis.
#[derive(Clone, Debug)]
pub struct SobolDecomposition {
    basis: SparseBasis,
    conversion: Matrix,
    /// By parameter: the first parameter of its cause.
    cause: Vec<usize>,
}

impl SobolDecomposition {
    /// Prepares the conversion. Parameters of a zone are one cause: its shares are those of each of them.
    pub fn new(basis: &SparseBasis, zones: &[Vec<usize>]) -> Self {
        let highest = basis.orders().iter().max().copied().unwrap_or(0);
        let of = |axis: usize| zones.iter().find(|zone| zone.contains(&axis)).map_or(axis, |zone| zone[0]);
        let cause = (0..basis.dimension()).map(of).collect();
        Self { basis: basis.clone(), conversion: from_chebyshev(highest.into()), cause }
    }

    /// Sobol indices of a polynomial; `None` if it does not vary, or if a coefficient is infinite or NaN.
    pub fn indices(&self, coefficients: &[f64]) -> Option<SobolIndices> {
        assert_eq!(coefficients.len(), self.basis.len(), "coefficients of another shape");
        let k = self.basis.dimension();
        // Relative to the largest, so that no square over- or underflows.
        let scale = coefficients[1..].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let varies = scale > 0.0;
        if !varies || coefficients.iter().any(|c| !c.is_finite()) {
            return None;
        }
        let mut terms: Vec<f64> = coefficients.iter().map(|c| c / scale).collect();
        terms[0] = 0.0;
        for axis in 0..k {
            for fibre in self.basis.fibres(axis).iter() {
                for (l, row) in
                    self.conversion.entries.chunks_exact(self.conversion.columns).enumerate().take(fibre.len())
                {
                    // Only degrees from l on, which are still Chebyshev's.
                    let line = fibre.iter().zip(row).skip(l);
                    terms[fibre[l] as usize] = line.map(|(&t, weight)| weight * terms[t as usize]).sum();
                }
            }
        }
        let (mut main, mut total, mut variance) = (vec![0.0; k], vec![0.0; k], 0.0);
        let mut last = vec![0; k];
        for (term, c) in terms.iter().enumerate().skip(1) {
            let degrees = self.basis.degrees(term);
            let part = c * c;
            variance += part;
            let mut active = (0..k).filter(|&axis| degrees[axis] > 0).map(|axis| self.cause[axis]);
            let first = active.next().unwrap_or(0); // only the first term is constant
            total[first] += part;
            last[first] = term;
            let mut alone = true;
            for cause in active {
                // Several parameters of a zone may be active in one term.
                if std::mem::replace(&mut last[cause], term) != term {
                    total[cause] += part;
                    alone = false;
                }
            }
            main[first] += if alone { part } else { 0.0 };
        }
        main.iter_mut().chain(&mut total).for_each(|share| *share /= variance);
        let interactions = (1.0 - main.iter().sum::<f64>()).max(0.0);
        let [main, total] = [main, total].map(|own| self.cause.iter().map(|&cause| own[cause]).collect());
        Some(SobolIndices { main, total, interactions })
    }
}

/// Column j: C_j in Legendre polynomials normalised so that the mean of each one's square over [−1, 1] is 1.
fn from_chebyshev(n: usize) -> Matrix {
    // Rows of coefficients before P_l: C_{j+1} = 2x C_j − C_{j−1}, x P_l = ((l + 1) P_{l+1} + l P_{l−1})/(2l + 1).
    let mut columns = vec![vec![0.0; n + 1]; n + 1];
    columns[0][0] = 1.0;
    for j in 0..n {
        let factor = if j == 0 { 1.0 } else { 2.0 };
        let mut next: Vec<f64> = if j == 0 { vec![0.0; n + 1] } else { columns[j - 1].iter().map(|c| -c).collect() };
        for (l, c) in columns[j].iter().enumerate().take(j + 1) {
            let share = factor * c / (2 * l + 1) as f64;
            next[l + 1] += (l + 1) as f64 * share;
            if l > 0 {
                next[l - 1] += l as f64 * share;
            }
        }
        columns[j + 1] = next;
    }
    // The mean of P_l² is 1/(2l + 1).
    Matrix::new(n + 1, n + 1, |l, j| columns[j][l] / ((2 * l + 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::sparse_grid::SparseGrid;
    use super::super::sparse_transform::{SparseTransform, TransformWork};
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn indices(grid: &SparseGrid, f: impl Fn(&[f64]) -> f64) -> Option<SobolIndices> {
        let transform = SparseTransform::new(grid);
        let values: Vec<f64> = (0..grid.len()).map(|index| f(&grid.sample(index))).collect();
        let mut c = vec![0.0; values.len()];
        transform.coefficients(&values, &mut c, &mut TransformWork::default());
        SobolDecomposition::new(transform.basis(), &[]).indices(&c)
    }

    #[test]
    fn ishigamis_function() {
        // sin x₁ + a sin² x₂ + b x₃⁴ sin x₁ on [−π, π]³, of which the variances are known.
        let (a, b) = (7.0, 0.1);
        let f = |xi: &[f64]| {
            let x = [PI * xi[0], PI * xi[1], PI * xi[2]];
            x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin()
        };
        let first = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
        let second = a * a / 8.0;
        let both = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let variance = first + second + both;
        let found = indices(&SparseGrid::tensor(&[32, 32, 4]), f).unwrap();
        let expected = [(first, first + both), (second, second), (0.0, both)];
        for ((main, total), expected) in found.main.iter().zip(&found.total).zip(expected) {
            assert!((main - expected.0 / variance).abs() < 1e-9 && (total - expected.1 / variance).abs() < 1e-9);
        }
        assert!((found.interactions - both / variance).abs() < 1e-9);
        let published = [0.3139, 0.4424, 0.0, 0.5576, 0.4424, 0.2437];
        for (share, published) in found.main.iter().chain(&found.total).zip(published) {
            assert!((share - published).abs() < 1e-4);
        }
    }

    #[test]
    fn constant_function_has_no_shares() {
        let basis = SobolDecomposition::new(&SparseBasis::tensor(&[1, 1]), &[]);
        assert_eq!(basis.indices(&[3.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(basis.indices(&[3.0, 0.0, f64::NAN, 1.0]), None);
        assert_eq!(SobolDecomposition::new(&SparseBasis::tensor(&[]), &[]).indices(&[3.0]), None);
        // Small or large, shares are the same.
        for scale in [1e-300, 1.0, 1e300] {
            let found = basis.indices(&[scale, scale, 0.0, 0.0]).unwrap();
            assert_eq!((found.main, found.total, found.interactions), (vec![0.0, 1.0], vec![0.0, 1.0], 0.0));
        }
    }

    proptest! {
        #[test]
        fn sums_have_no_interactions(weights in prop::collection::vec(0.1..1.0_f64, 4)) {
            // The variance of w ξ² is 4w²/45, that of w ξ is w²/3.
            let f = |xi: &[f64]| weights[0] * xi[0] + weights[1] * xi[1] + weights[2] * xi[2] * xi[2] + weights[3] * xi[3] * xi[3];
            let found = indices(&SparseGrid::tensor(&[2, 2, 2, 2]), f).unwrap();
            let parts: Vec<f64> = weights.iter().zip([3.0, 3.0, 11.25, 11.25]).map(|(w, by)| w * w / by).collect();
            let variance: f64 = parts.iter().sum();
            for ((main, total), part) in found.main.iter().zip(&found.total).zip(&parts) {
                prop_assert!((main - part / variance).abs() < 1e-13 && (total - main).abs() < 1e-13);
            }
            prop_assert!(found.interactions < 1e-13);
        }

        #[test]
        fn shares_match_quadrature(c in prop::collection::vec(-1.0..1.0_f64, 12)) {
            // Main effect of the first parameter by quadrature: the variance of the mean over the second.
            let basis = SparseBasis::tensor(&[3, 2]);
            let found = SobolDecomposition::new(&basis, &[]).indices(&c).unwrap();
            // Gauss's two points in each of many cells: an error of about 1e-6 for these degrees.
            let half = 1.0 / 24.0;
            let nodes: Vec<f64> = (0..24)
                .map(|cell| -1.0 + half * f64::from(2 * cell + 1))
                .flat_map(|middle| [-1.0, 1.0].map(|side| middle + half * side / 3.0_f64.sqrt()))
                .collect();
            let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / 48.0;
            let given = |x: f64| mean(&mut nodes.iter().map(|&y| basis.evaluate(&c, &[x, y])));
            let whole = mean(&mut nodes.iter().map(|&x| given(x)));
            let main = mean(&mut nodes.iter().map(|&x| (given(x) - whole).powi(2)));
            let variance =
                mean(&mut nodes.iter().map(|&x| mean(&mut nodes.iter().map(|&y| (basis.evaluate(&c, &[x, y]) - whole).powi(2)))));
            prop_assert!((found.main[0] - main / variance).abs() < 1e-4);
        }
    }
}
