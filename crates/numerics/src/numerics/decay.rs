//! Truncation error of a polynomial, estimated from the decay of its coefficients.
//!
//! Chebyshev coefficients of an analytic response fall as ρ^−j. Their fall from the middle degree to the highest gives
//! ρ, and the missing terms beyond are the rest of the geometric series. Where they do not fall, as at a narrow
//! resonance, it is large, whatever the samples between the nodes say.

use symdiff::math;

use super::sparse_basis::{Before, SparseBasis};
use super::tuning::TUNING;

/// Size of the terms beyond those of a polynomial; zero if degrees are too low to estimate it.
///
/// A tensor lacks higher degrees along each axis. A sparse set lacks the terms beyond its front: a term there has the
/// size that follows from the terms before it as for a power of a weighted sum of the parameters, the least over all
/// axes. Terms of the whole front, and those beyond them, add up by their squares, as terms of either sign do.
pub fn truncation(basis: &SparseBasis, coefficients: &[f64]) -> f64 {
    let tails = (0..basis.dimension()).map(|axis| Tail::along(basis, coefficients, axis));
    if basis.is_tensor() {
        return tails.flatten().map(|tail| tail.last * tail.rate / (1.0 - tail.rate)).sum();
    }
    let rates: Vec<Option<f64>> = tails.map(|tail| tail.map(|tail| tail.rate)).collect();
    let size = |term: Option<u32>| term.map_or(0.0, |term| coefficients[term as usize].abs());
    let beyond = |index: &[Before]| -> Option<f64> {
        let (mut least, mut slowest) = (f64::INFINITY, 0.0_f64);
        let sum: f64 = index.iter().map(|before| f64::from(before.degree)).sum();
        for before in index {
            let rate = (rates[usize::from(before.axis)]? * sum / f64::from(before.degree)).min(TUNING.slowest_decay);
            // Even or odd degrees may be missing.
            least = least.min(rate * size(Some(before.last)).max(rate * size(before.earlier)));
            slowest = slowest.max(rate);
        }
        // The squares of a series.
        Some(least * least / (1.0 - slowest * slowest))
    };
    basis.front().filter_map(beyond).sum::<f64>().sqrt()
}

/// Decay of the coefficients along an axis.
struct Tail {
    /// Size of those of the highest degree,
    last: f64,
    /// and the share of the degree before that each has.
    rate: f64,
}

impl Tail {
    /// `None` if higher coefficients are zero, or if the degree is too low.
    fn along(basis: &SparseBasis, coefficients: &[f64], axis: usize) -> Option<Self> {
        let n = usize::from(basis.orders()[axis]);
        if n < TUNING.least_degree {
            return None;
        }
        // Largest of those of a degree and above.
        let mut envelope = vec![0.0_f64; n + 1];
        let is_tensor = basis.is_tensor();
        for (term, c) in coefficients.iter().enumerate() {
            let degrees = basis.degrees(term);
            let degree = usize::from(degrees[axis]);
            // The higher a degree of a sparse set, the fewer terms have it: those of one parameter alone can be
            // compared.
            if !is_tensor && degrees.iter().map(|&degree| usize::from(degree)).sum::<usize>() > degree {
                continue;
            }
            envelope[degree] = envelope[degree].max(c.abs());
        }
        (0..n).rev().for_each(|degree| envelope[degree] = envelope[degree].max(envelope[degree + 1]));
        if envelope[n - 1] == 0.0 {
            return None;
        }
        // Even or odd ones may be missing, so that pairs are compared. If they fall ever faster, the last ratio is less
        // than that over all higher degrees; in waves they may stand still.
        let fall = |from: usize| math::pow(envelope[n - 1] / envelope[from], 1.0 / (n - 1 - from) as f64);
        let overall = fall(n / 2);
        let rate = fall(n - 3).clamp(TUNING.caution * overall, overall).min(TUNING.slowest_decay);
        Some(Self { last: envelope[n].max(rate * envelope[n - 1]), rate })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{PointSet, SparseGrid, SparseWork, Surrogate, SurrogateWork};

    /// The stated error, and the largest true error.
    fn told(n: usize, f: impl Fn(f64) -> f64) -> (f64, f64) {
        let surrogate = Surrogate::tensor(&[n], &[n + 1]);
        let values: Vec<f64> = surrogate.samples().iter().map(|xi| f(xi[0])).collect();
        let c = surrogate.coefficients(&values, &mut SurrogateWork::default());
        let xi: Vec<[f64; 1]> = (0..=4000).map(|i| [f64::from(i) / 2000.0 - 1.0]).collect();
        let mut found = vec![0.0; xi.len()];
        surrogate.basis().values(PointSet::of(&xi).points(), &c, &mut found, &mut SparseWork::default());
        let error = xi.iter().zip(&found).map(|(xi, found)| (found - f(xi[0])).abs()).fold(0.0, f64::max);
        (truncation(surrogate.basis(), &c), error)
    }

    #[test]
    fn estimate_has_the_size_of_the_error() {
        for (n, width) in [(6, 1.0), (8, 0.7), (12, 0.4), (20, 0.2), (9, 0.5)] {
            for shift in [0.0, 0.3, -0.7] {
                let (told, error) = told(n, |x| 1.0 / (1.0 + ((x - shift) / width).powi(2)));
                assert!(told > 0.25 * error && told < 25.0 * error, "{n}, {width}, {shift}: {told:.1e} of {error:.1e}");
            }
        }
    }

    /// Estimate and error of a sparse set in two parameters, whose terms are those of a total degree.
    fn told_of_sparse(n: u8, f: impl Fn(f64, f64) -> f64) -> (f64, f64) {
        let mut grid = SparseGrid::new(&[n; 2]);
        let indices = (1..=n).flat_map(|sum| (0..=sum).map(move |first| [first, sum - first]));
        indices.for_each(|levels| grid.add(&levels));
        let surrogate = Surrogate::sparse(&grid);
        let values: Vec<f64> = surrogate.samples().iter().map(|xi| f(xi[0], xi[1])).collect();
        let c = surrogate.coefficients(&values, &mut SurrogateWork::default());
        let at = |i: usize| i as f64 / 50.0 - 1.0;
        let xi: Vec<[f64; 2]> = (0..=100).flat_map(|i| (0..=100).map(move |j| [at(i), at(j)])).collect();
        let mut found = vec![0.0; xi.len()];
        surrogate.basis().values(PointSet::of(&xi).points(), &c, &mut found, &mut SparseWork::default());
        let error = xi.iter().zip(&found).map(|(xi, found)| (found - f(xi[0], xi[1])).abs()).fold(0.0, f64::max);
        (truncation(surrogate.basis(), &c), error)
    }

    /// A bump's terms have either sign; a pole's add up in one corner, where they are more than that.
    #[test]
    fn estimate_of_sparse_sets_is_near_their_error() {
        for n in [8, 12, 20] {
            for (a, b) in [(0.5, 0.4), (0.7, 0.1), (-0.3, 0.6)] {
                let (told, error) = told_of_sparse(n, |x, y| (-(x - a).powi(2) / 0.5 - (y - b).powi(2) / 0.8).exp());
                assert!(told > 0.05 * error && told < 25.0 * error, "{n}, {a}, {b}: {told:.1e} of {error:.1e}");
                let (told, error) = told_of_sparse(n, |x, y| 1.0 / (1.4 + a * x + b * y));
                assert!(told > 0.01 * error && told < 25.0 * error, "{n}, {a}, {b}: {told:.1e} of {error:.1e}");
            }
        }
        // Where parameters do not act together nothing is missing between them.
        let (told, error) = told_of_sparse(20, |x, y| x.exp() + (2.0 * y).cos());
        assert!(told < 1e-9 && error < 1e-9, "{told:.1e}, {error:.1e}");
    }

    #[test]
    fn needle_has_a_large_estimate_and_smooth_function_none() {
        let (told_needle, _) = told(12, |x| 1.0 / (1.0 + ((x - 0.31) / 0.02).powi(2)));
        let (told_smooth, error) = told(12, |x| (2.0 * x).cos());
        assert!(told_needle > 0.05 && told_smooth < 1e-8 && error < 1e-8, "{told_needle} {told_smooth} {error}");
    }
}
