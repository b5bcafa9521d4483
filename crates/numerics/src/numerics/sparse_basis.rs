//! Polynomials of many parameters with few terms: f(ξ) = Σ c_t Π C_j(ξᵢ), where most terms have few factors.

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Vectorise, vectorised};

#[cfg(test)]
use super::point_set::PointSet;
use super::point_set::Points;
use super::sparse_grid::SparseGrid;
use super::tuning::TUNING;

/// Points or lines treated together.
pub(super) const LANES: usize = 8;
/// One number for each of them.
pub(super) type Lanes = [f64; LANES];

/// Products of Chebyshev polynomials with downward-closed degrees: with a term, all that are nowhere of higher degree.
/// The first is the constant. Coefficients of one polynomial are a number for each term.
#[derive(Clone, Debug)]
pub struct SparseBasis {
    dimension: usize,
    /// Degree along each axis, term after term.
    degrees: Vec<u8>,
    /// Factors of each term but the first.
    factors: Vec<Factor>,
    /// Highest degree along each axis.
    orders: Vec<u8>,
    fibres: Vec<Fibres>,
    /// Indices just beyond the terms of a set that is no tensor, where degrees are high enough to estimate the missing
    /// terms.
    front: Vec<Vec<Before>>,
}

/// Terms before an index that is beyond the terms, along one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before {
    pub axis: u8,
    /// The index's degree along it.
    pub degree: u8,
    /// The term of one degree less,
    pub last: u32,
    /// and that of two, if there is one.
    pub earlier: Option<u32>,
}

/// A term is an earlier one times one polynomial of an axis on which that one is constant.
#[derive(Clone, Copy, Debug)]
struct Factor {
    earlier: u32,
    /// Index in the table of all axes' polynomials.
    polynomial: u32,
}

/// Terms that differ only in their degree along one axis, in the order of that degree, which starts with 0; where there
/// are at least two.
#[derive(Clone, Debug, Default)]
pub(super) struct Fibres {
    terms: Vec<u32>,
    ends: Vec<u32>,
}

impl Fibres {
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| &self.terms[std::mem::replace(&mut start, end as usize)..end as usize])
    }
}

/// Buffers for evaluation, reused between calls.
#[derive(Clone, Debug, Default)]
pub struct SparseWork {
    polynomials: Vec<Lanes>,
    terms: Vec<Lanes>,
}

impl SparseBasis {
    /// The polynomials that values at a grid's nodes determine; term i has the degrees of node i's index.
    pub fn new(grid: &SparseGrid) -> Self {
        let degrees = (0..grid.len()).flat_map(|index| grid.levels(index)).copied().collect();
        Self::closed(grid.dimension(), grid.len(), degrees)
    }

    /// All terms up to `orders[i]` ≤ 255 in parameter i, the last index fastest, as in `ChebyshevBasis`.
    pub fn tensor(orders: &[u8]) -> Self {
        let count = orders.iter().map(|&n| usize::from(n) + 1).product();
        let mut degrees = Vec::with_capacity(count * orders.len());
        let mut next = vec![0; orders.len()];
        loop {
            degrees.extend_from_slice(&next);
            let Some(axis) = (0..orders.len()).rev().find(|&axis| next[axis] < orders[axis]) else { break };
            next[axis] += 1;
            next[axis + 1..].fill(0);
        }
        Self::closed(orders.len(), count, degrees)
    }

    /// The basis of downward-closed degrees, each term after those that it has as factors.
    fn closed(dimension: usize, count: usize, degrees: Vec<u8>) -> Self {
        let term = |t: usize| &degrees[t * dimension..][..dimension];
        let places: FxHashMap<&[u8], u32> = (0..count).map(|t| (term(t), t as u32)).collect();
        let orders: Vec<u8> = (0..dimension).map(|axis| (0..count).map(|t| term(t)[axis]).max().unwrap_or(0)).collect();
        let first_polynomials: Vec<u32> =
            orders.iter().scan(0, |next, &n| Some(std::mem::replace(next, *next + u32::from(n) + 1))).collect();

        let factor = |t: usize| {
            let mut earlier = term(t).to_vec();
            // Terms from the second on have a positive degree.
            let axis = earlier.iter().rposition(|&j| j > 0).expect("only the first term is constant");
            let polynomial = first_polynomials[axis] + u32::from(std::mem::take(&mut earlier[axis]));
            Factor { earlier: places[earlier.as_slice()], polynomial }
        };
        let factors = (1..count).map(factor).collect();

        let fibres = (0..dimension).map(|axis| {
            let mut fibres = Fibres::default();
            for start in (0..count).filter(|&t| term(t)[axis] == 0) {
                let mut next = term(start).to_vec();
                let first = fibres.terms.len();
                while let Some(&t) = places.get(next.as_slice()) {
                    fibres.terms.push(t);
                    if next[axis] == orders[axis] {
                        break;
                    }
                    next[axis] += 1;
                }
                if fibres.terms.len() == first + 1 {
                    fibres.terms.pop();
                } else {
                    fibres.ends.push(fibres.terms.len() as u32);
                }
            }
            fibres
        });
        let fibres = fibres.collect();
        let front = if is_tensor(&orders, count) { Vec::new() } else { front(&degrees, &orders, &places) };
        Self { dimension, factors, orders, fibres, front, degrees }
    }

    /// Whether all terms up to the highest degrees are there.
    pub(super) fn is_tensor(&self) -> bool {
        is_tensor(&self.orders, self.len())
    }

    /// Indices just beyond the terms: with one of them these stay closed. Only those along axes of a degree that is
    /// high enough to estimate the missing terms; none of a tensor.
    pub(super) fn front(&self) -> impl Iterator<Item = &[Before]> {
        self.front.iter().map(Vec::as_slice)
    }

    /// Number of parameters, k.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of terms, which is that of coefficients.
    #[allow(clippy::len_without_is_empty)] // the constant is always there
    pub fn len(&self) -> usize {
        self.factors.len() + 1
    }

    /// Degree along each axis of a term.
    pub fn degrees(&self, term: usize) -> &[u8] {
        &self.degrees[term * self.dimension..][..self.dimension]
    }

    /// Highest degree along each axis.
    pub fn orders(&self) -> &[u8] {
        &self.orders
    }

    pub(super) fn fibres(&self, axis: usize) -> &Fibres {
        &self.fibres[axis]
    }

    /// Values of all terms at many points, point by point.
    pub fn terms(&self, points: Points) -> Vec<Vec<f64>> {
        let mut work = SparseWork::default();
        let mut all = Vec::with_capacity(points.len());
        for first in (0..points.len()).step_by(LANES) {
            let points = points.part(first, LANES);
            self.products(points, &mut work);
            all.extend((0..points.len()).map(|lane| work.terms.iter().map(|term| term[lane]).collect::<Vec<f64>>()));
        }
        all
    }

    /// Value at ξ ∈ [−1, 1]^k of the polynomial with these coefficients.
    #[cfg(test)]
    pub fn evaluate(&self, coefficients: &[f64], xi: &[f64]) -> f64 {
        let mut value = [0.0];
        self.values(PointSet::of(&[xi]).points(), coefficients, &mut value, &mut SparseWork::default());
        value[0]
    }

    /// Values of many polynomials at many points: `coefficients` are those of one polynomial after the other, and so
    /// are their values in `out`, which has a number for each polynomial and point. Allocates only when `work` is first
    /// used.
    pub fn values(&self, points: Points, coefficients: &[f64], out: &mut [f64], work: &mut SparseWork) {
        assert_eq!(coefficients.len() * points.len(), out.len() * self.len(), "a value for each polynomial and point");
        vectorised(Evaluation { basis: self, points, coefficients, out, work });
    }
}

fn is_tensor(orders: &[u8], terms: usize) -> bool {
    orders.iter().fold(1_usize, |count, &n| count.saturating_mul(usize::from(n) + 1)) == terms
}

/// The indices just beyond some terms, each with its predecessors.
fn front(degrees: &[u8], orders: &[u8], places: &FxHashMap<&[u8], u32>) -> Vec<Vec<Before>> {
    let tells = |axis: usize| usize::from(orders[axis]) >= TUNING.least_degree;
    let (mut seen, mut front) = (FxHashSet::default(), Vec::new());
    for (term, axis) in
        degrees.chunks_exact(orders.len()).flat_map(|term| (0..orders.len()).map(move |axis| (term, axis)))
    {
        let mut index = term.to_vec();
        index[axis] = index[axis].saturating_add(1);
        if !(0..index.len()).all(|axis| index[axis] == 0 || tells(axis)) || places.contains_key(index.as_slice()) {
            continue;
        }
        let levels = index.clone();
        let mut lower = |axis: usize, by: u8| {
            let degree = index[axis];
            index[axis] = degree.checked_sub(by)?;
            let known = places.get(index.as_slice()).copied();
            index[axis] = degree;
            known
        };
        let before = |axis: usize| {
            let (last, earlier) = (lower(axis, 1)?, lower(axis, 2));
            Some(Before { axis: axis as u8, degree: levels[axis], last, earlier })
        };
        let along: Vec<usize> =
            (0..orders.len()).filter(|&axis| term[axis] > 0).chain((term[axis] == 0).then_some(axis)).collect();
        if let Some(before) = along.into_iter().map(before).collect::<Option<Vec<Before>>>()
            && seen.insert(index.clone())
        {
            front.push(before);
        }
    }
    front
}

/// [`SparseBasis::values`], compiled for wide vectors.
struct Evaluation<'a> {
    basis: &'a SparseBasis,
    points: Points<'a>,
    coefficients: &'a [f64],
    out: &'a mut [f64],
    work: &'a mut SparseWork,
}

impl Vectorise for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { basis, points, coefficients, out, work } = self;
        for first in (0..points.len()).step_by(LANES) {
            let points = points.part(first, LANES);
            basis.products(points, work);
            let lines = coefficients.chunks_exact(basis.len()).zip(out.chunks_exact_mut(self.points.len()));
            for (coefficients, out) in lines {
                let mut sum = [0.0; LANES];
                for (c, term) in coefficients.iter().zip(&work.terms) {
                    sum.iter_mut().zip(term).for_each(|(sum, term)| *sum += c * term);
                }
                out[first..][..points.len()].copy_from_slice(&sum[..points.len()]);
            }
        }
    }
}

impl SparseBasis {
    /// The terms at up to `LANES` points.
    #[inline(always)]
    fn products(&self, points: Points, work: &mut SparseWork) {
        self.polynomials(points, &mut work.polynomials);
        work.terms.clear();
        work.terms.push([1.0; LANES]);
        for factor in &self.factors {
            let (earlier, polynomial) =
                (&work.terms[factor.earlier as usize], &work.polynomials[factor.polynomial as usize]);
            let term = std::array::from_fn(|lane| earlier[lane] * polynomial[lane]);
            work.terms.push(term);
        }
    }

    /// C_j(ξᵢ), j = 0…nᵢ, axis after axis; lanes without a point stay at ξ = 0.
    #[inline(always)]
    fn polynomials(&self, points: Points, out: &mut Vec<Lanes>) {
        out.clear();
        for (axis, &n) in self.orders.iter().enumerate() {
            let x: Lanes =
                std::array::from_fn(|lane| if lane < points.len() { points.coordinate(lane, axis) } else { 0.0 });
            let (mut last, mut this) = (x, [1.0; LANES]);
            for _ in 0..=n {
                out.push(this);
                let next = std::array::from_fn(|lane| 2.0 * x[lane] * this[lane] - last[lane]);
                (last, this) = (this, next);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chebyshev::ChebyshevBasis;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fibres_are_lines_of_terms() {
        // Degrees 00 01 02 10 11 12: along the last axis two lines of three, along the first three of two.
        let basis = SparseBasis::tensor(&[1, 2]);
        let lines = |axis| basis.fibres(axis).iter().map(<[u32]>::to_vec).collect::<Vec<_>>();
        assert_eq!(lines(1), [vec![0, 1, 2], vec![3, 4, 5]]);
        assert_eq!(lines(0), [vec![0, 3], vec![1, 4], vec![2, 5]]);
    }

    proptest! {
        #[test]
        fn tensor_values_match_the_dense_basis(
            c in prop::collection::vec(-1.0..1.0_f64, 48),
            points in prop::collection::vec(prop::array::uniform3(-1.0..=1.0_f64), 1..20),
        ) {
            let (sparse, tensor) = (SparseBasis::tensor(&[1, 3, 2]), ChebyshevBasis::new(&[1, 3, 2], &[2, 4, 3]));
            let mut values = vec![0.0; 2 * points.len()];
            let set = PointSet::of(&points);
            sparse.values(set.points(), &c, &mut values, &mut SparseWork::default());
            for (line, values) in c.chunks_exact(24).zip(values.chunks_exact(points.len())) {
                for (xi, value) in points.iter().zip(values) {
                    prop_assert!((value - tensor.evaluate(line, xi)).abs() < 1e-14);
                }
                for (terms, value) in sparse.terms(set.points()).iter().zip(values) {
                    prop_assert_eq!(line.iter().zip(terms).map(|(c, term)| c * term).sum::<f64>(), *value);
                }
            }
        }
    }
}
