//! Values of tensor Chebyshev polynomials, by which tests check coefficients and ranges.

use super::chebyshev::ChebyshevBasis;
use super::samples::TensorGrid;
use super::tensor::{Matrix, Separable, Work};

impl ChebyshevBasis {
    /// Degree in each parameter.
    fn orders(&self) -> impl DoubleEndedIterator<Item = usize> + ExactSizeIterator {
        self.quadrature.axes.iter().map(|axis| axis.rows - 1)
    }

    /// Value of the polynomial at ξ ∈ [−1, 1]^k, by Clenshaw's recurrence along each axis, the last first.
    pub fn evaluate(&self, coefficients: &[f64], xi: &[f64]) -> f64 {
        let mut values = coefficients.to_vec();
        for (n, &x) in self.orders().zip(xi).rev() {
            values = values.chunks_exact(n + 1).map(|row| clenshaw(row, x)).collect();
        }
        values[0]
    }

    /// Evaluator of polynomials of this basis at all samples of a grid.
    pub fn on(&self, grid: &TensorGrid) -> OnGrid {
        let axis = |(axis, n)| {
            let points = grid.axis(axis);
            let mut entries = Vec::with_capacity(points.len() * (n + 1));
            for &x in points {
                let (mut last, mut this) = (x, 1.0);
                for _ in 0..=n {
                    entries.push(this);
                    (last, this) = (this, 2.0 * x * this - last);
                }
            }
            Matrix { rows: points.len(), columns: n + 1, entries }
        };
        OnGrid(Separable::new(self.orders().enumerate().map(axis).collect()))
    }
}

/// Evaluation of polynomials of one basis at all samples of one grid; made once for any number of them.
#[derive(Clone, Debug)]
pub struct OnGrid(Separable);

impl OnGrid {
    /// Values of the polynomial, in the grid's order.
    pub fn values(&self, coefficients: &[f64]) -> Vec<f64> {
        std::mem::take(self.0.apply(coefficients, &mut Work::default()))
    }
}

/// Σ cᵢ Cᵢ(x).
pub fn clenshaw(coefficients: &[f64], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &c in coefficients[1..].iter().rev() {
        (b1, b2) = (c + 2.0 * x * b1 - b2, b1);
    }
    coefficients[0] + x * b1 - b2
}
