//! Polynomials of many parameters from few samples whose derivatives are known: each gives k + 1 numbers.
//!
//! The terms are the constant, those of first and second degree in each parameter, and products of two parameters:
//! those with which derivatives vary most, as many as the samples determine well. Coefficients follow from weighted
//! least squares over values and derivatives (Peng, Hampton & Doostan, J. Comput. Phys. 310 (2016) 440).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::sparse_basis::SparseBasis;
use super::sparse_grid::SparseGrid;
use super::tuning::TUNING;

/// A term: the product of Chebyshev polynomials of these degrees.
#[derive(Clone, Copy, Debug)]
enum Term {
    Constant,
    First(usize),
    Second(usize),
    Product(usize, usize),
}

impl Term {
    fn value(self, xi: &[f64]) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::First(axis) => xi[axis],
            Self::Second(axis) => 2.0 * xi[axis] * xi[axis] - 1.0,
            Self::Product(a, b) => xi[a] * xi[b],
        }
    }

    /// Derivatives that are not zero, each with its axis.
    fn slopes(self, xi: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        let [first, second] = match self {
            Self::Constant => [None, None],
            Self::First(axis) => [Some((axis, 1.0)), None],
            Self::Second(axis) => [Some((axis, 4.0 * xi[axis])), None],
            Self::Product(a, b) => [Some((a, xi[b])), Some((b, xi[a]))],
        };
        first.into_iter().chain(second)
    }
}

/// A function's derivatives by all parameters (k), sample by sample.
pub struct Derivatives<'d> {
    /// The derivatives.
    pub slopes: Vec<&'d [f64]>,
    /// Differences of this size matter.
    pub scale: f64,
}

/// Pairs of parameters, first those whose product has the largest coefficient in some function, estimated from the
/// change of one parameter's derivatives with the other: for values spread evenly the mean square of ξ is 1/3.
fn products(points: &[Vec<f64>], functions: &[Derivatives<'_>]) -> Vec<(usize, usize)> {
    let k = points.first().map_or(0, Vec::len);
    let share = 3.0 / points.len() as f64;
    let mut largest = vec![0.0_f64; k * k];
    let mut changes = vec![0.0; k * k];
    for Derivatives { slopes, scale } in functions.iter().filter(|own| own.scale > 0.0) {
        let mean: Vec<f64> =
            (0..k).map(|axis| slopes.iter().map(|own| own[axis]).sum::<f64>() / points.len() as f64).collect();
        changes.fill(0.0);
        for (point, own) in points.iter().zip(slopes) {
            for (a, changes) in changes.chunks_exact_mut(k).enumerate() {
                let change = share * (own[a] - mean[a]);
                changes.iter_mut().zip(point).for_each(|(of_pair, xi)| *of_pair += change * xi);
            }
        }
        for a in 0..k {
            for b in a + 1..k {
                let coefficient = 0.5 * (changes[a * k + b] + changes[b * k + a]) / scale;
                largest[a * k + b] = largest[a * k + b].max(coefficient.abs());
            }
        }
    }
    let mut pairs: Vec<(usize, usize)> = (0..k).flat_map(|a| (a + 1..k).map(move |b| (a, b))).collect();
    pairs.sort_by(|x, y| largest[y.0 * k + y.1].total_cmp(&largest[x.0 * k + x.1]).then(x.cmp(y)));
    pairs
}

/// Fits through one set of samples.
#[derive(Clone, Debug)]
pub struct GradientFit {
    terms: Vec<Term>,
    basis: SparseBasis,
    /// ξ of the samples.
    points: Vec<Vec<f64>>,
    normal: Cholesky<f64, Dyn>,
}

impl GradientFit {
    /// Fit through samples at these ξ, for functions with these derivatives there. `None` if samples are too few for
    /// terms of first and second degree.
    pub fn new(points: Vec<Vec<f64>>, functions: &[Derivatives<'_>]) -> Option<Self> {
        let k = points.first()?.len();
        let room = (points.len() * (k + 1) / TUNING.equations_a_term).min(TUNING.most_terms).checked_sub(2 * k + 1)?;
        let mut products = products(&points, functions);
        products.truncate(room);
        let products = products.into_iter().map(|(a, b)| Term::Product(a, b));
        let alone = (0..k).map(Term::First).chain((0..k).map(Term::Second));
        let terms: Vec<Term> = [Term::Constant].into_iter().chain(alone).chain(products).collect();
        let mut matrix = DMatrix::<f64>::zeros(points.len() * (k + 1), terms.len());
        for (number, point) in points.iter().enumerate() {
            for (column, term) in terms.iter().enumerate() {
                matrix[(number * (k + 1), column)] = term.value(point);
                term.slopes(point).for_each(|(axis, slope)| {
                    matrix[(number * (k + 1) + 1 + axis, column)] = TUNING.weight_of_derivative * slope
                });
            }
        }
        let mut normal = matrix.tr_mul(&matrix);
        let ridge = TUNING.ridge * normal.diagonal().max();
        (0..terms.len()).for_each(|term| normal[(term, term)] += ridge);
        let basis = SparseBasis::new(&grid(k, &terms));
        Some(Self { normal: Cholesky::new(normal)?, terms, basis, points })
    }

    /// The terms' basis.
    pub fn basis(&self) -> &SparseBasis {
        &self.basis
    }

    /// Coefficients of the terms, from values and derivatives (k each) at the samples.
    pub fn coefficients<'s>(&self, samples: impl Iterator<Item = (f64, &'s [f64])>) -> Vec<f64> {
        let mut projected = DVector::<f64>::zeros(self.terms.len());
        for (point, (value, slopes)) in self.points.iter().zip(samples) {
            for (own, term) in projected.iter_mut().zip(&self.terms) {
                let along: f64 = term.slopes(point).map(|(axis, slope)| slope * slopes[axis]).sum();
                *own += term.value(point) * value + TUNING.weight_of_derivative * TUNING.weight_of_derivative * along;
            }
        }
        self.normal.solve(&projected).data.into()
    }

    /// The value of a polynomial at a point.
    pub fn value(&self, coefficients: &[f64], xi: &[f64]) -> f64 {
        self.terms.iter().zip(coefficients).map(|(term, own)| own * term.value(xi)).sum()
    }

    /// A point of the box where `sign` times a polynomial has a local maximum, from `start`: it goes to the best along
    /// each axis in turn.
    pub fn maximum(&self, coefficients: &[f64], sign: f64, start: &[f64]) -> Vec<f64> {
        let k = start.len();
        let (mut linear, mut bend) = (vec![0.0; k], vec![0.0; k]);
        let mut products: Vec<Vec<(usize, f64)>> = vec![Vec::new(); k];
        for (term, coefficient) in self.terms.iter().zip(coefficients) {
            let own = sign * coefficient;
            match *term {
                Term::Constant => {}
                Term::First(axis) => linear[axis] += own,
                Term::Second(axis) => bend[axis] += 4.0 * own,
                Term::Product(a, b) => {
                    products[a].push((b, own));
                    products[b].push((a, own));
                }
            }
        }
        let mut point = start.to_vec();
        for _ in 0..TUNING.sweeps {
            let mut moved = 0.0_f64;
            for axis in 0..k {
                let at_middle =
                    linear[axis] + products[axis].iter().map(|&(other, own)| own * point[other]).sum::<f64>();
                let target = match bend[axis] < 0.0 {
                    true => (-at_middle / bend[axis]).clamp(-1.0, 1.0),
                    false if at_middle == 0.0 => point[axis],
                    false => at_middle.signum(),
                };
                moved = moved.max((target - point[axis]).abs());
                point[axis] = target;
            }
            if moved < 1e-6 {
                break;
            }
        }
        point
    }
}

/// A grid whose indices are the terms' degrees.
fn grid(k: usize, terms: &[Term]) -> SparseGrid {
    let mut grid = SparseGrid::new(&vec![2; k]);
    for term in terms {
        let mut levels = vec![0; k];
        match *term {
            Term::Constant => continue,
            Term::First(axis) => levels[axis] = 1,
            Term::Second(axis) => levels[axis] = 2,
            Term::Product(a, b) => (levels[a], levels[b]) = (1, 1),
        }
        grid.add(&levels);
    }
    grid
}

#[cfg(test)]
mod tests {
    use super::super::point_set::PointSet;
    use super::super::samples::spread;
    use super::super::sparse_basis::SparseWork;
    use super::*;

    /// 1 + 2 ξ₀ − 3 ξ₁² + ξ₀ ξ₂ of eight parameters, from twelve samples where 45 terms would take 45 values.
    #[test]
    fn derivatives_replace_samples() {
        let value = |xi: &[f64]| 1.0 + 2.0 * xi[0] - 3.0 * xi[1] * xi[1] + xi[0] * xi[2];
        let slopes = |xi: &[f64]| {
            let mut slopes = vec![0.0; 8];
            (slopes[0], slopes[1], slopes[2]) = (2.0 + xi[2], -6.0 * xi[1], xi[0]);
            slopes
        };
        let points = spread(8, 12);
        let known: Vec<(f64, Vec<f64>)> = points.iter().map(|xi| (value(xi), slopes(xi))).collect();
        let own = Derivatives { slopes: known.iter().map(|(_, slopes)| slopes.as_slice()).collect(), scale: 1.0 };
        let fit = GradientFit::new(points, &[own]).unwrap();
        // 108 equations for 27 terms, of which 17 are of one parameter.
        assert_eq!(fit.basis().len(), 27);
        let coefficients = fit.coefficients(known.iter().map(|(value, slopes)| (*value, slopes.as_slice())));
        let corners = [vec![1.0; 8], vec![-0.5; 8]];
        let mut found = [0.0; 2];
        fit.basis().values(PointSet::of(&corners).points(), &coefficients, &mut found, &mut SparseWork::default());
        for (corner, found) in corners.iter().zip(found) {
            assert!((found - value(corner)).abs() < 1e-6, "{found}");
            assert!((fit.value(&coefficients, corner) - value(corner)).abs() < 1e-6);
        }
        // Greatest at (1, 0, 1, …): 4; least at (−1, ±1, 1, …): −5.
        let most = fit.maximum(&coefficients, 1.0, &[0.0; 8]);
        assert!((value(&most) - 4.0).abs() < 1e-6, "{most:?}");
        let least = fit.maximum(&coefficients, -1.0, &[0.1; 8]);
        assert!((value(&least) + 5.0).abs() < 1e-6, "{least:?}");
    }

    #[test]
    fn few_samples_are_refused() {
        let points = spread(8, 7);
        let none = vec![0.0; 8];
        let own = Derivatives { slopes: vec![none.as_slice(); 7], scale: 1.0 };
        assert!(GradientFit::new(points, &[own]).is_none());
    }
}
