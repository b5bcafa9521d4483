//! Linear least squares of many right-hand sides, with leave-one-out errors of the samples.

use super::tuning::TUNING;
use nalgebra::{DMatrix, DVector};

/// The factorisation of a matrix whose rows are the values of all terms at a sample.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    q: DMatrix<f64>,
    r: DMatrix<f64>,
    /// Factors of the columns.
    scales: Vec<f64>,
    /// Factors of the rows.
    weights: Vec<f64>,
    /// Leverages: the share of each sample's value in the fit's value there.
    leverages: Vec<f64>,
}

impl LeastSquares {
    /// Factorises the values of all terms, sample by sample, with the weight of each sample; `None` if the samples do
    /// not determine all terms.
    pub fn new(terms: &[Vec<f64>], weights: Vec<f64>) -> Option<Self> {
        let (samples, count) = (terms.len(), terms.first()?.len());
        if samples < count || count == 0 {
            return None;
        }
        let mut matrix = DMatrix::from_fn(samples, count, |sample, term| weights[sample] * terms[sample][term]);
        let scales: Vec<f64> = matrix.column_iter().map(|column| column.norm().recip()).collect();
        if scales.iter().any(|scale| !scale.is_finite()) {
            return None;
        }
        scales.iter().enumerate().for_each(|(term, scale)| matrix.column_mut(term).scale_mut(*scale));
        let qr = matrix.qr();
        let (q, r) = (qr.q(), qr.r());
        let diagonal = r.diagonal().abs();
        let leverages = q.row_iter().map(|row| row.norm_squared()).collect();
        (diagonal.min() > TUNING.zero_diagonal * diagonal.max()).then_some(Self { q, r, scales, weights, leverages })
    }

    /// Square of how far an error of one in every sample may move the fit at a point with these values of the terms; of
    /// points among the samples it is at most 1.
    pub fn leverage(&self, terms: &[f64]) -> f64 {
        let scaled =
            DVector::from_iterator(terms.len(), terms.iter().zip(&self.scales).map(|(term, scale)| term * scale));
        let solved = self.r.tr_solve_upper_triangular(&scaled);
        solved.map_or(f64::INFINITY, |solved| solved.norm_squared())
    }

    /// Coefficients of the terms, and by how much each sample differs from the fit to all others.
    pub fn fit(&self, values: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let weighted = DVector::from_iterator(values.len(), values.iter().zip(&self.weights).map(|(y, w)| y * w));
        let projected = self.q.tr_mul(&weighted);
        let solved = self.r.solve_upper_triangular(&projected)?;
        let residuals = &weighted - &self.q * &projected;
        let left_out = residuals.iter().enumerate().map(|(sample, residual)| {
            let leverage = self.leverages[sample];
            if leverage < TUNING.most_leverage {
                residual / (1.0 - leverage) / self.weights[sample]
            } else {
                f64::INFINITY
            }
        });
        Some((solved.iter().zip(&self.scales).map(|(value, scale)| value * scale).collect(), left_out.collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line through three points of which one is off: errors without each are those of lines through the other two.
    #[test]
    fn leave_one_out_errors_are_exact() {
        let terms: Vec<Vec<f64>> = [0.0, 1.0, 2.0].iter().map(|x| vec![1.0, *x]).collect();
        let squares = LeastSquares::new(&terms, vec![1.0; 3]).unwrap();
        let (coefficients, left_out) = squares.fit(&[0.0, 1.0, 5.0]).unwrap();
        // Normal equations: slope 5/2, mean 2.
        assert!((coefficients[1] - 2.5).abs() < 1e-14 && (coefficients[0] + 0.5).abs() < 1e-14);
        let expected = [3.0, -1.5, 3.0];
        assert!(left_out.iter().zip(expected).all(|(own, other)| (own - other).abs() < 1e-13), "{left_out:?}");
        assert!(LeastSquares::new(&terms[..1], vec![1.0]).is_none());
        // 1/3 + 1/2 at an end of the three, 1/3 + 9/2 two beyond it.
        let leverages = [2.0, 4.0].map(|x| squares.leverage(&[1.0, x]));
        assert!((leverages[0] - 5.0 / 6.0).abs() < 1e-14 && (leverages[1] - 29.0 / 6.0).abs() < 1e-13);
    }
}
