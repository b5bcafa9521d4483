//! Polynomials in the parameters from samples: on full grids of few parameters, or on sparse ones that grow.

use super::chebyshev::ChebyshevBasis;
use super::sparse_basis::SparseBasis;
use super::sparse_grid::SparseGrid;
use super::sparse_transform::{SparseTransform, TransformWork};
use super::tensor::Work;

/// The samples that polynomials of one shape are made from, and how.
#[derive(Clone, Debug)]
pub struct Surrogate {
    samples: Vec<Vec<f64>>,
    basis: SparseBasis,
    fit: Fit,
    middle: usize,
}

#[derive(Clone, Debug)]
enum Fit {
    /// Quadrature at the zeros of a Chebyshev polynomial along each axis.
    Quadrature(ChebyshevBasis),
    /// Interpolation at nested nodes.
    Interpolation(Box<SparseTransform>),
}

/// Buffers for [`Surrogate::coefficients`], reused between calls.
#[derive(Clone, Debug, Default)]
pub struct SurrogateWork {
    tensor: Work,
    sparse: TransformWork,
}

impl Surrogate {
    /// Surrogate of degree `orders[i]` ≤ 255 in parameter i, from `nodes[i]` nodes along it.
    pub fn tensor(orders: &[usize], nodes: &[usize]) -> Self {
        let quadrature = ChebyshevBasis::new(orders, nodes);
        let grid = quadrature.grid();
        let degrees: Vec<u8> = orders.iter().map(|&n| u8::try_from(n).unwrap_or(u8::MAX)).collect();
        Self {
            samples: (0..grid.len()).map(|index| grid.sample(index)).collect(),
            basis: SparseBasis::tensor(&degrees),
            fit: Fit::Quadrature(quadrature),
            middle: grid.len() / 2,
        }
    }

    /// Surrogate through the values at a grid's nodes.
    pub fn sparse(grid: &SparseGrid) -> Self {
        let transform = SparseTransform::new(grid);
        Self {
            samples: (0..grid.len()).map(|index| grid.sample(index)).collect(),
            basis: transform.basis().clone(),
            fit: Fit::Interpolation(Box::new(transform)),
            middle: 0,
        }
    }

    /// ξ of every sample.
    pub fn samples(&self) -> &[Vec<f64>] {
        &self.samples
    }

    /// A sample in the middle of the box, or near it.
    pub fn middle(&self) -> usize {
        self.middle
    }

    /// Basis of the coefficients.
    pub fn basis(&self) -> &SparseBasis {
        &self.basis
    }

    /// Coefficients of many quantities from their values at the samples, one quantity after the other in both.
    pub fn coefficients(&self, values: &[f64], work: &mut SurrogateWork) -> Vec<f64> {
        match &self.fit {
            Fit::Quadrature(quadrature) => {
                let lines = values.chunks_exact(self.samples.len());
                lines.flat_map(|line| quadrature.coefficients(line, &mut work.tensor).to_vec()).collect()
            }
            Fit::Interpolation(transform) => {
                let mut coefficients = vec![0.0; values.len()];
                transform.coefficients(values, &mut coefficients, &mut work.sparse);
                coefficients
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{PointSet, SparseWork};

    #[test]
    fn both_surrogates_reproduce_polynomials_of_their_degree() {
        let f = |xi: &[f64]| 1.0 + 2.0 * xi[0] - xi[1] * xi[1] + 0.5 * xi[0] * xi[0] * xi[1];
        for surrogate in [Surrogate::tensor(&[3, 2], &[4, 5]), Surrogate::sparse(&SparseGrid::tensor(&[3, 2]))] {
            let values: Vec<f64> = surrogate.samples().iter().map(|xi| f(xi)).collect();
            let twice: Vec<f64> = values.iter().copied().chain(values.iter().map(|value| 2.0 * value)).collect();
            let coefficients = surrogate.coefficients(&twice, &mut SurrogateWork::default());
            let points = [[0.3, -0.7], [1.0, 1.0]];
            let mut found = [0.0; 4];
            surrogate.basis().values(
                PointSet::of(&points).points(),
                &coefficients,
                &mut found,
                &mut SparseWork::default(),
            );
            for (index, xi) in points.iter().enumerate() {
                assert!((found[index] - f(xi)).abs() < 1e-14 && (found[2 + index] - 2.0 * f(xi)).abs() < 1e-14);
            }
        }
    }
}
