//! What a polynomial lacks, by how its coefficients decay.
//!
//! Chebyshev coefficients of an analytic response fall as ρ^−j. What they have fallen to from the middle degree to the highest tells ρ,
//! and what is missing beyond is the rest of the geometric series. Where they do not fall, as at a narrow resonance, it is large,
//! whatever the samples between the nodes say.

use symdiff::math;

use super::sparse_basis::SparseBasis;

/// Lower degrees are too few to tell a rate.
const LEAST_DEGREE: usize = 6;
/// Share of the rate over all higher degrees that the rate at the highest has at least.
const CAUTION: f64 = 0.7;
/// Slower than this is taken for no decay at all.
const SLOWEST: f64 = 0.99;

/// Size of the terms beyond the highest degrees of a tensor polynomial; zero where a degree is too low to tell.
pub fn truncation(basis: &SparseBasis, coefficients: &[f64]) -> f64 {
    let is_tensor = basis.orders().iter().map(|&n| usize::from(n) + 1).product::<usize>() == basis.len();
    if !is_tensor {
        return 0.0;
    }
    let along = |(axis, &n): (usize, &u8)| {
        let n = usize::from(n);
        if n < LEAST_DEGREE {
            return 0.0;
        }
        // Largest of those of a degree and above.
        let mut envelope = vec![0.0_f64; n + 1];
        for (term, c) in coefficients.iter().enumerate() {
            let degree = usize::from(basis.degrees(term)[axis]);
            envelope[degree] = envelope[degree].max(c.abs());
        }
        (0..n).rev().for_each(|degree| envelope[degree] = envelope[degree].max(envelope[degree + 1]));
        if envelope[n - 1] == 0.0 {
            return 0.0;
        }
        // Even or odd ones may be missing, so that pairs are compared. Falling ever faster, they tell less than over all higher degrees;
        // in waves they may stand still.
        let fall = |from: usize| math::pow(envelope[n - 1] / envelope[from], 1.0 / (n - 1 - from) as f64);
        let overall = fall(n / 2);
        let rate = fall(n - 3).clamp(CAUTION * overall, overall).min(SLOWEST);
        envelope[n].max(rate * envelope[n - 1]) * rate / (1.0 - rate)
    };
    basis.orders().iter().enumerate().map(along).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{SparseWork, Surrogate, SurrogateWork};

    /// The stated error, and the largest true error.
    fn told(n: usize, f: impl Fn(f64) -> f64) -> (f64, f64) {
        let surrogate = Surrogate::tensor(&[n], &[n + 1]);
        let values: Vec<f64> = surrogate.samples().iter().map(|xi| f(xi[0])).collect();
        let c = surrogate.coefficients(&values, &mut SurrogateWork::default());
        let xi: Vec<[f64; 1]> = (0..=4000).map(|i| [f64::from(i) / 2000.0 - 1.0]).collect();
        let mut found = vec![0.0; xi.len()];
        surrogate.basis().values(&xi, &c, &mut found, &mut SparseWork::default());
        let error = xi.iter().zip(&found).map(|(xi, found)| (found - f(xi[0])).abs()).fold(0.0, f64::max);
        (truncation(surrogate.basis(), &c), error)
    }

    #[test]
    fn it_is_of_the_size_of_the_error() {
        for (n, width) in [(6, 1.0), (8, 0.7), (12, 0.4), (20, 0.2), (9, 0.5)] {
            for shift in [0.0, 0.3, -0.7] {
                let (told, error) = told(n, |x| 1.0 / (1.0 + ((x - shift) / width).powi(2)));
                assert!(told > 0.25 * error && told < 25.0 * error, "{n}, {width}, {shift}: {told:.1e} of {error:.1e}");
            }
        }
    }

    #[test]
    fn a_needle_is_seen_and_what_is_resolved_has_none() {
        let (told_needle, _) = told(12, |x| 1.0 / (1.0 + ((x - 0.31) / 0.02).powi(2)));
        let (told_smooth, error) = told(12, |x| (2.0 * x).cos());
        assert!(told_needle > 0.05 && told_smooth < 1e-8 && error < 1e-8, "{told_needle} {told_smooth} {error}");
    }
}
