//! The range of a sparse polynomial of many parameters, proven: branch and bound on boxes.
//!
//! On a box, re-expanded there, a polynomial is treated in three ways:
//!
//! - *Monotone axes.* Where the constant of ∂f/∂ξᵢ outweighs the sum of its other coefficients, f is largest at an end of
//!   that axis, which is then gone.
//! - *An upper bound.* |c (ξᵢ − uᵢ)(ξⱼ − uⱼ)| ≤ |c|/2 ((ξᵢ − uᵢ)² + (ξⱼ − uⱼ)²) for any point u, so constant, linear, quadratic
//!   and bilinear terms are together below a sum of parabolas, one for each axis, whose maxima are known; every other term is
//!   below |c|. With u at their maximum, if couplings do not outweigh curvatures, that is exact, where |c| for each
//!   bilinear term would ask for ever smaller boxes. The middle of the box as u is the better one for corners.
//! - *Values*, at u and at a corner: what is attained.
//!
//! The box with the highest bound is split first, along the axis that its bound loses most by: in halves, or, where f is linear
//! along it, into its two ends. So at any time the highest bound holds for the whole.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::range::Range;
use super::sparse_basis::{SparseBasis, SparseWork};

/// Steps towards the maximum of a part's terms up to second degree.
const ASCENTS: usize = 8;

/// A polynomial's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProvenRange {
    /// No value of the polynomial lies outside. Unknown if any coefficient is infinite or not a number.
    pub range: Range,
    /// Between the least and the largest value that were attained.
    pub attained: Range,
    /// Whether both ends are as near to attained values as was asked for; if not, the work limit came first.
    pub complete: bool,
}

/// Bounds polynomials of one basis; all that does not depend on the coefficients is computed once. Clone it for each thread.
#[derive(Clone, Debug)]
pub struct SparseRange {
    basis: SparseBasis,
    tolerance: f64,
    most_parts: usize,
    kinds: Vec<Kind>,
    /// Bilinear terms and their axes.
    bilinear: Vec<(usize, usize, usize)>,
    /// C_j(½y + ½) in Chebyshev polynomials of y: coefficients of each j, up to the highest degree.
    upper_half: Vec<Vec<f64>>,
    /// Bound on the rounding errors of a value, relative to Σ|c|.
    rounding: f64,
    heap: BinaryHeap<Part>,
    /// Coefficients of parts that are done with, to be used again.
    spare: Vec<Vec<f64>>,
    axes: Vec<Axis>,
    points: [Vec<f64>; 2],
    work: SparseWork,
}

/// What a term is in the bound.
#[derive(Clone, Debug)]
enum Kind {
    Constant,
    Linear(usize),
    Quadratic(usize),
    Bilinear(usize, usize),
    Other,
}

/// What a part's terms say of an axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    linear: f64,
    quadratic: f64,
    /// Σ|c| of its bilinear terms.
    bilinear: f64,
    /// Derivative of its bilinear terms at a point.
    gradient: f64,
    /// What the bound may lose by it.
    loss: f64,
    /// Highest degree of all terms that are not zero.
    degree: u8,
}

/// How a part is split.
#[derive(Clone, Copy, Debug)]
enum Split {
    Halves(usize),
    /// Along an axis along which f is linear.
    Ends(usize),
}

/// What is known of a largest value.
#[derive(Clone, Copy, Debug)]
struct Maximum {
    bound: f64,
    attained: f64,
    complete: bool,
}

/// A part of the domain: the polynomial on it, and what bounds it. Axes along which it is largest at an end are gone: constant.
#[derive(Clone, Debug)]
struct Part {
    bound: f64,
    /// Where the bound loses most; nowhere if it is attained.
    split: Option<Split>,
    coefficients: Vec<f64>,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Part {}
impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl SparseRange {
    /// Bounds shall be as near to attained values as `tolerance` times the width of the attained range; `most_parts` parts of
    /// the domain are looked at for each of the two bounds, then they are taken as they stand.
    pub fn new(basis: &SparseBasis, tolerance: f64, most_parts: usize) -> Self {
        let kind = |term| {
            let active = |degrees: &[u8]| -> Vec<(usize, u8)> {
                degrees.iter().copied().enumerate().filter(|(_, j)| *j > 0).collect()
            };
            match active(basis.degrees(term))[..] {
                [] => Kind::Constant,
                [(axis, 1)] => Kind::Linear(axis),
                [(axis, 2)] => Kind::Quadratic(axis),
                [(a, 1), (b, 1)] => Kind::Bilinear(a, b),
                _ => Kind::Other,
            }
        };
        let kinds: Vec<Kind> = (0..basis.len()).map(kind).collect();
        let bilinear = kinds.iter().enumerate().filter_map(|(term, kind)| match *kind {
            Kind::Bilinear(a, b) => Some((term, a, b)),
            _ => None,
        });
        let highest = usize::from(basis.orders().iter().max().copied().unwrap_or(0));
        Self {
            tolerance,
            most_parts,
            bilinear: bilinear.collect(),
            kinds,
            upper_half: upper_half(highest),
            // A sum of all terms after some fifty splits along a line of terms.
            rounding: (basis.len() + 50 * (highest + 2)) as f64 * f64::EPSILON,
            heap: BinaryHeap::new(),
            spare: Vec::new(),
            axes: vec![Axis::default(); basis.dimension()],
            points: [vec![0.0; basis.dimension()], vec![0.0; basis.dimension()]],
            work: SparseWork::default(),
            basis: basis.clone(),
        }
    }

    /// Range of the polynomial with these coefficients. Exact for a constant; never wider than c₀ ± Σ|c|.
    pub fn range(&mut self, coefficients: &[f64]) -> ProvenRange {
        assert_eq!(coefficients.len(), self.basis.len(), "coefficients of another shape");
        let (middle, radius) = (coefficients[0], coefficients[1..].iter().map(|c| c.abs()).sum::<f64>());
        if !(radius.is_finite() && middle.is_finite()) {
            return ProvenRange { range: Range::UNKNOWN, attained: Range::UNKNOWN, complete: false };
        }
        // A first look at the least value, so that the search for the largest knows about the width.
        let mut lowest = f64::NEG_INFINITY;
        let whole = self.whole(coefficients, -1.0);
        let part = self.part(whole, &mut lowest);
        self.spare.push(part.coefficients);
        let above = self.maximum(coefficients, 1.0, lowest);
        let below = self.maximum(coefficients, -1.0, above.attained);
        let rounding = self.rounding * radius;
        ProvenRange {
            range: Range {
                lower: middle - (below.bound + rounding).min(radius),
                upper: middle + (above.bound + rounding).min(radius),
            },
            attained: Range { lower: middle - below.attained, upper: middle + above.attained },
            complete: above.complete && below.complete,
        }
    }

    /// sign · f without its constant, so that a small variation of a large value is not lost in the rounding of the value.
    fn whole(&mut self, coefficients: &[f64], sign: f64) -> Vec<f64> {
        let mut whole = self.spare.pop().unwrap_or_default();
        whole.clear();
        whole.extend(coefficients.iter().map(|c| sign * c));
        whole[0] = 0.0;
        whole
    }

    /// The largest value of sign · f; `opposite` is about the largest of −sign · f.
    fn maximum(&mut self, coefficients: &[f64], sign: f64, opposite: f64) -> Maximum {
        let mut attained = f64::NEG_INFINITY;
        let whole = self.whole(coefficients, sign);
        let part = self.part(whole, &mut attained);
        self.heap.push(part);
        let mut looked_at = 1;
        while let Some(part) = self.heap.pop() {
            let close = part.bound - attained <= self.tolerance * (attained + opposite).max(0.0);
            let (Some(split), true) = (part.split, !close && looked_at < self.most_parts) else {
                let bound = part.bound.max(attained);
                let rest = self.heap.drain().map(|part| part.coefficients);
                self.spare.extend(rest.chain([part.coefficients]));
                return Maximum { bound, attained, complete: close || part.split.is_none() };
            };
            looked_at += 2;
            let upper = part.coefficients;
            let mut lower = self.spare.pop().unwrap_or_default();
            lower.clone_from(&upper);
            for (mut half, side) in [(lower, -1.0), (upper, 1.0)] {
                match split {
                    Split::Halves(axis) => self.halve(&mut half, axis, side),
                    Split::Ends(axis) => to_end(&self.basis, &mut half, axis, side),
                }
                let part = self.part(half, &mut attained);
                if part.bound > attained {
                    self.heap.push(part);
                } else {
                    self.spare.push(part.coefficients);
                }
            }
        }
        Maximum { bound: attained, attained, complete: true } // every part was bounded by a value attained elsewhere
    }

    /// Takes out monotone axes, bounds what is left, and looks at two of its points.
    fn part(&mut self, mut coefficients: Vec<f64>, attained: &mut f64) -> Part {
        for _ in 0..self.basis.dimension() {
            let mut fixed = false;
            for axis in 0..self.basis.dimension() {
                if let Some(end) = self.monotone(&coefficients, axis) {
                    to_end(&self.basis, &mut coefficients, axis, end);
                    fixed = true;
                }
            }
            if !fixed {
                break;
            }
        }

        self.axes.fill(Axis::default());
        let mut bound = coefficients[0];
        for (term, (&c, kind)) in coefficients.iter().zip(&self.kinds).enumerate() {
            if c == 0.0 {
                continue;
            }
            match *kind {
                Kind::Constant => continue,
                Kind::Linear(axis) => self.axes[axis].linear = c,
                Kind::Quadratic(axis) => self.axes[axis].quadratic = c,
                Kind::Bilinear(a, b) => {
                    self.axes[a].bilinear += c.abs();
                    self.axes[b].bilinear += c.abs();
                }
                Kind::Other => bound += c.abs(),
            }
            let alone = matches!(kind, Kind::Linear(_) | Kind::Quadratic(_));
            for (axis, &degree) in self.axes.iter_mut().zip(self.basis.degrees(term)).filter(|(_, degree)| **degree > 0)
            {
                axis.degree = axis.degree.max(degree);
                axis.loss += if alone { 0.0 } else { f64::from(degree) * c.abs() };
            }
        }
        let mut split = None;
        let mut most = 0.0;
        for (place, axis) in self.axes.iter().enumerate() {
            self.points[0][place] = parabola(axis.linear, axis.quadratic).0;
            self.points[1][place] = 0.0;
            if axis.loss > most {
                most = axis.loss;
                split = Some(if axis.degree == 1 { Split::Ends(place) } else { Split::Halves(place) });
            }
        }
        let about_middle = self.parabolas(&coefficients, 1);
        for (xi, axis) in self.points[1].iter_mut().zip(&self.axes) {
            *xi = if axis.linear < 0.0 { -1.0 } else { 1.0 };
        }
        if self.axes.iter().any(|axis| axis.bilinear > 0.0) {
            (0..ASCENTS).for_each(|_| self.ascend(&coefficients));
        }
        bound += about_middle.min(self.parabolas(&coefficients, 0));
        let mut values = [0.0; 2];
        self.basis.values(&self.points, &coefficients, &mut values, &mut self.work);
        *attained = attained.max(values[0]).max(values[1]);
        Part { bound, split, coefficients }
    }

    /// Upper bound of the linear, quadratic and bilinear terms by parabolas that are exact at point u:
    /// c ξᵢξⱼ ≤ c (uⱼξᵢ + uᵢξⱼ − uᵢuⱼ) + |c|/2 ((ξᵢ − uᵢ)² + (ξⱼ − uⱼ)²).
    fn parabolas(&mut self, coefficients: &[f64], point: usize) -> f64 {
        let mut bound = self.gradients(coefficients, point);
        for (axis, u) in self.axes.iter().zip(&self.points[point]) {
            // ½(ξ − u)² = ¼ C₂ − uξ + ¼ + ½u²
            let w = axis.bilinear;
            bound += w * (0.25 + 0.5 * u * u);
            bound += parabola(axis.linear + axis.gradient - w * u, axis.quadratic + 0.25 * w).1;
        }
        bound
    }

    /// Moves the first point to the maximum of the parabolas that are below f's linear, quadratic and bilinear terms and
    /// exact there: never down.
    fn ascend(&mut self, coefficients: &[f64]) {
        self.gradients(coefficients, 0);
        for (axis, u) in self.axes.iter().zip(&mut self.points[0]) {
            let w = axis.bilinear;
            *u = parabola(axis.linear + axis.gradient + w * *u, axis.quadratic - 0.25 * w).0;
        }
    }

    /// Derivatives of the bilinear terms at a point, and their sum's negative there.
    fn gradients(&mut self, coefficients: &[f64], point: usize) -> f64 {
        self.axes.iter_mut().for_each(|axis| axis.gradient = 0.0);
        let u = &self.points[point];
        let mut negative = 0.0;
        for &(term, a, b) in &self.bilinear {
            let c = coefficients[term];
            self.axes[a].gradient += c * u[b];
            self.axes[b].gradient += c * u[a];
            negative -= c * u[a] * u[b];
        }
        negative
    }

    /// The end of an axis at which f is largest, if it is monotone along it and not constant.
    fn monotone(&self, coefficients: &[f64], axis: usize) -> Option<f64> {
        let (mut constant, mut rest) = (0.0, 0.0);
        for fibre in self.basis.fibres(axis).iter() {
            // The coefficients of ∂f/∂ξ, as in [`SparseBasis::derivative`].
            let (mut this, mut last, mut sum) = (0.0, 0.0, 0.0_f64);
            for j in (1..fibre.len()).rev() {
                (this, last) = (last + 2.0 * j as f64 * coefficients[fibre[j] as usize], this);
                sum += if j > 1 { f64::abs(this) } else { 0.0 };
            }
            if fibre[0] == 0 {
                constant = 0.5 * this;
                rest += sum;
            } else {
                rest += sum + f64::abs(0.5 * this);
            }
        }
        // Where rounding might decide, both ends are looked at.
        let decided = f64::abs(constant) > rest * (1.0 + 1e-12) && constant != 0.0;
        decided.then(|| f64::signum(constant))
    }

    /// Replaces a polynomial by what it is on the lower or upper half of an axis.
    fn halve(&self, coefficients: &mut [f64], axis: usize, side: f64) {
        for fibre in self.basis.fibres(axis).iter() {
            for (i, &term) in fibre.iter().enumerate() {
                // C_j(½y − ½) has the upper half's coefficients with signs (−1)^(i+j).
                let part = |j: usize| {
                    let sign = if (i + j).is_multiple_of(2) { 1.0 } else { side };
                    sign * self.upper_half[j][i] * coefficients[fibre[j] as usize]
                };
                coefficients[term as usize] = (i..fibre.len()).map(part).sum();
            }
        }
    }
}

/// Replaces a polynomial by what it is at an end of an axis, ±1.
fn to_end(basis: &SparseBasis, coefficients: &mut [f64], axis: usize, end: f64) {
    for fibre in basis.fibres(axis).iter() {
        let (mut sum, mut sign) = (0.0, 1.0);
        for &term in fibre {
            sum += sign * std::mem::take(&mut coefficients[term as usize]);
            sign *= end;
        }
        coefficients[fibre[0] as usize] = sum;
    }
}

/// Where a x + b C₂(x) is largest in [−1, 1], and that value.
fn parabola(a: f64, b: f64) -> (f64, f64) {
    if 4.0 * b < -a.abs() {
        let x = -0.25 * a / b;
        (x, a * x + b * (2.0 * x * x - 1.0))
    } else {
        (if a < 0.0 { -1.0 } else { 1.0 }, a.abs() + b)
    }
}

/// Row j: C_j(½y + ½) in Chebyshev polynomials of y, by C_{j+1} = (y + 1) C_j − C_{j−1}.
fn upper_half(n: usize) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; n + 1]; n + 1];
    rows[0][0] = 1.0;
    for j in 0..n {
        let mut next = vec![0.0; n + 1];
        for i in 0..=j {
            // y C_i = (C_{i+1} + C_{|i−1|})/2; the first step is x C₀ = (y + 1)/2.
            let c = if j == 0 { 0.5 } else { 1.0 } * rows[j][i];
            next[i] += c;
            next[i + 1] += 0.5 * c;
            next[i.abs_diff(1)] += 0.5 * c;
        }
        if j > 0 {
            next.iter_mut().zip(&rows[j - 1]).for_each(|(next, before)| *next -= before);
        }
        rows[j + 1] = next;
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::super::samples::TensorGrid;
    use super::super::sparse_grid::SparseGrid;
    use super::super::sparse_transform::{SparseTransform, TransformWork};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn halves() {
        // C₂(½y + ½) = ½(y + 1)² − 1 = −¼ + C₁ + ¼ C₂
        assert_eq!(upper_half(2), [vec![1.0, 0.0, 0.0], vec![0.5, 0.5, 0.0], vec![-0.25, 1.0, 0.25]]);
        let range = SparseRange::new(&SparseBasis::tensor(&[7, 2]), 0.0, 1);
        let c: Vec<f64> = (0..24).map(|t| (f64::from(t) * 1.7).sin()).collect();
        for side in [-1.0, 1.0] {
            let mut half = c.clone();
            range.halve(&mut half, 0, side);
            for y in [-1.0, -0.3, 0.8] {
                let (whole, half) =
                    (range.basis.evaluate(&c, &[0.5 * (y + side), 0.4]), range.basis.evaluate(&half, &[y, 0.4]));
                assert!((whole - half).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn parabolas() {
        // x − C₂ = 1 + x − 2x²: 9/8 at ¼. −8x − C₂ is monotone.
        assert_eq!(parabola(1.0, -1.0), (0.25, 1.125));
        assert_eq!(parabola(-8.0, -1.0), (-1.0, 7.0));
        assert_eq!(parabola(-1.0, 2.0), (-1.0, 3.0));
    }

    #[test]
    fn constants_are_exact_and_the_undefined_is_unknown() {
        for orders in [&[2, 1][..], &[0, 0], &[]] {
            let basis = SparseBasis::tensor(orders);
            let mut c = vec![0.0; basis.len()];
            c[0] = 0.1;
            let found = SparseRange::new(&basis, 1e-3, 100).range(&c);
            assert_eq!((found.range, found.complete), (Range { lower: 0.1, upper: 0.1 }, true));
            for hole in 0..c.len() {
                let mut c = c.clone();
                c[hole] = f64::NAN;
                assert!(SparseRange::new(&basis, 1e-3, 100).range(&c).range.lower.is_nan());
            }
        }
    }

    #[test]
    fn an_interior_extremum_of_many_parameters() {
        // −Σ (ξ − c)² − ½ (Σ (ξ − c))²/k in twenty parameters: 0 inside, and least at a corner.
        let k = 20;
        let centre = |axis: usize| 0.6 * (1.9 * axis as f64).sin();
        let grid = quadratic_grid(k);
        let f = |xi: &[f64]| {
            let centred = || xi.iter().enumerate().map(|(axis, x)| x - centre(axis));
            -centred().map(|d| d * d).sum::<f64>() - 0.5 / k as f64 * centred().sum::<f64>().powi(2)
        };
        let values: Vec<f64> = (0..grid.len()).map(|index| f(&grid.sample(index))).collect();
        let mut c = vec![0.0; values.len()];
        let transform = SparseTransform::new(&grid);
        transform.coefficients(&values, &mut c, &mut TransformWork::default());
        let found = SparseRange::new(transform.basis(), 1e-3, 1000).range(&c);
        let width = found.attained.width();
        assert!(found.complete && found.range.width() < 1.0021 * width, "{found:?}");
        assert!(found.range.upper >= 0.0 && found.range.upper < 1e-3 * width, "{found:?}");
    }

    /// All that is quadratic or bilinear.
    fn quadratic_grid(k: usize) -> SparseGrid {
        let mut grid = SparseGrid::new(&vec![1; k]);
        for axes in 0..2 {
            let pairs = grid.candidates().into_iter().filter(|c| c.levels.iter().sum::<u8>() == axes + 1);
            pairs.collect::<Vec<_>>().iter().for_each(|c| drop(grid.add(&c.levels)));
        }
        grid
    }

    #[test]
    fn a_work_limit_is_told() {
        let basis = SparseBasis::tensor(&[3, 3, 3]);
        let c: Vec<f64> = (0..64).map(|t| (f64::from(t) * 2.3).sin()).collect();
        let (short, long) =
            (SparseRange::new(&basis, 1e-3, 3).range(&c), SparseRange::new(&basis, 1e-3, 1 << 16).range(&c));
        assert!(!short.complete && long.complete);
        assert!(short.range.lower <= long.range.lower && long.range.upper <= short.range.upper);
        assert!(long.range.width() <= 1.0021 * long.attained.width());
    }

    /// Orders and coefficients that fall with the degree, as those of smooth responses do.
    fn decaying() -> impl Strategy<Value = (Vec<u8>, Vec<f64>)> {
        let orders = prop_oneof![
            prop::collection::vec(0..6_u8, 1..=3),
            prop::collection::vec(1..4_u8, 4..=5),
            prop::collection::vec(1..=2_u8, 6..=8),
        ];
        orders.prop_flat_map(|orders| {
            let count = orders.iter().map(|&n| usize::from(n) + 1).product::<usize>();
            let basis = SparseBasis::tensor(&orders);
            let decayed = move |c: Vec<f64>| {
                let sum = |t| basis.degrees(t).iter().map(|&j| i32::from(j)).sum::<i32>();
                c.iter().enumerate().map(|(t, c)| c * 0.15_f64.powi(sum(t))).collect()
            };
            (Just(orders), prop::collection::vec(-1.0..1.0_f64, count).prop_map(decayed))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn ranges_enclose_and_are_tight((orders, c) in decaying()) {
            let basis = SparseBasis::tensor(&orders);
            let found = SparseRange::new(&basis, 1e-3, 20_000).range(&c);
            let points = [0, 401, 41, 21, 9, 7, 5, 3, 3][orders.len()];
            let grid = TensorGrid::full_factorial(&vec![points; orders.len()]);
            let samples: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
            let mut values = vec![0.0; samples.len()];
            basis.values(&samples, &c, &mut values, &mut SparseWork::default());
            prop_assert!(found.complete, "{:?}", found);
            let rounding = 1e-14;
            prop_assert!(values.iter().all(|&v| found.range.lower - rounding <= v && v <= found.range.upper + rounding));
            prop_assert!(found.range.lower <= found.attained.lower + rounding);
            prop_assert!(found.attained.upper <= found.range.upper + rounding);
            prop_assert!(found.range.width() <= 1.0021 * found.attained.width() + rounding);
        }

        #[test]
        fn multilinear_ones_are_exact(k in 1..=8_usize, c in prop::collection::vec(-1.0..1.0_f64, 256)) {
            let basis = SparseBasis::tensor(&vec![1; k]);
            let c = &c[..basis.len()];
            let found = SparseRange::new(&basis, 0.0, 1 << 16).range(c);
            let corners = TensorGrid::full_factorial(&vec![2; k]);
            let values = (0..corners.len()).map(|index| basis.evaluate(c, &corners.sample(index)));
            let (lower, upper) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)));
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * 256.0;
            prop_assert!(found.complete && near(found.range.lower, lower) && near(found.range.upper, upper));
        }
    }
}
