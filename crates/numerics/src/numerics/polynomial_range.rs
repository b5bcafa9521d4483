//! The range of a tensor Chebyshev polynomial over [−1, 1]^k.
//!
//! Term by term (the paper's (18)), every C_j but the constant ranges over [−1, 1], so the polynomial lies in
//! c₀ ± Σ|c|. That forgets that the terms depend on the same parameters. The tight range is the intersection of it with
//! two enclosures from the polynomial's least and largest value on the grid θᵢ = π l/Nᵢ of Chebyshev extrema,
//! Nᵢ ≥ 16 nᵢ. With q(θ) = p(cos θ₁, …, cos θ_k) and δᵢ = π/(2Nᵢ), the largest distance to a grid line:
//!
//! - *Ehlich & Zeller (1964).* A polynomial of degree n has max|p| ≤ max over the grid of |p| / cos(n δ). Applied to
//!   one variable after the other, where each is a polynomial while the others are fixed: max|p| ≤ max over the tensor
//!   grid of |p| · Π 1/cos(nᵢ δᵢ). This bounds |p|, so it is applied to p − m, where m is the middle of the range [m −
//!   h, m + h] on the grid, and |p − m| ≤ h on the grid: no value lies outside m ± h Π 1/cos(nᵢ δᵢ). (At most 0.49 %
//!   wider for each parameter, as cos(π/32) = 1/1.0048.)
//! - *Taylor at the extremum.* q is even and periodic in each θᵢ, hence smooth on all of ℝ^k, and its largest value is
//!   taken where its gradient is zero, at the edges of the box too. Some grid point is at most δ away, and along the
//!   way there |q''| ≤ Σ |c_j| (Σᵢ jᵢ δᵢ)², since each term is a mean of cos(±j₁θ₁ ± …). So
//!   max q ≤ (max over the grid) + ½ Σ |c_j| (Σᵢ jᵢ δᵢ)², and likewise below. (For smooth responses, whose high
//!   coefficients are small, this is the sharper of the two by far.)
//!
//! Where that grid would be too large, the Bernstein form with branch and bound replaces it, within 0.1 % of the width
//! as far as its work limit allows. All hold up to rounding, for which a margin is added.

use std::f64::consts::FRAC_PI_2;

use super::bernstein::Bernstein;
use super::range::{Enclosed, Range};
use super::tensor::{Matrix, Separable, Work, cos_pi};
use super::tuning::TUNING;

/// Method for the range of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeKind {
    /// Interval evaluation term by term (the paper's).
    Interval,
    /// The polynomial's own range.
    Tight,
}

/// Grid intervals along each axis; `None` if the grid would be too large.
fn intervals(orders: &[usize]) -> Option<Vec<usize>> {
    let active = orders.iter().filter(|&&n| n > 0).count();
    let least = if active == 0 { 1 } else { *TUNING.min_intervals.get(active - 1)? };
    let counts: Vec<usize> = orders.iter().map(|&n| if n == 0 { 0 } else { least.max(TUNING.density * n) }).collect();
    let points = counts.iter().fold(1_usize, |points, count| points.saturating_mul(count + 1));
    (points <= TUNING.max_grid_points).then_some(counts)
}

/// Bounds polynomials of one shape; all that does not depend on the coefficients is computed once. Clone it for each
/// thread.
#[derive(Clone, Debug)]
pub struct PolynomialRange {
    kind: RangeKind,
    count: usize,
    enclosure: Enclosure,
    /// The coefficients without their constant.
    varying: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Enclosure {
    Grid(Box<ExtremaGrid>),
    Bernstein(Box<Bernstein>),
}

impl PolynomialRange {
    /// Range of polynomials of degree `orders[i]` in parameter i.
    pub fn new(orders: &[usize], kind: RangeKind) -> Self {
        let enclosure = match intervals(orders) {
            Some(intervals) => Enclosure::Grid(Box::new(ExtremaGrid::new(orders, &intervals))),
            None => Enclosure::Bernstein(Box::new(Bernstein::new(orders))),
        };
        Self { kind, count: orders.iter().map(|n| n + 1).product(), enclosure, varying: Vec::new() }
    }

    /// Range of the polynomial with these Chebyshev coefficients (last index fastest), and the range that values
    /// attain. Exact for a constant; unknown if any coefficient is infinite or NaN. Never wider than c₀ ± Σ|c|.
    pub fn enclose(&mut self, coefficients: &[f64]) -> Enclosed {
        assert_eq!(coefficients.len(), self.count, "coefficients of another shape");
        let radius: f64 = coefficients[1..].iter().map(|c| c.abs()).sum();
        let middle = coefficients[0];
        if !(radius.is_finite() && middle.is_finite()) {
            return Enclosed::UNKNOWN;
        }
        if radius == 0.0 {
            let constant = Range { lower: middle, upper: middle };
            return Enclosed { outer: constant, attained: constant };
        }
        // Without the constant, so that a small variation of a large value is not lost in the rounding of the value.
        self.varying.clear();
        self.varying.extend_from_slice(coefficients);
        self.varying[0] = 0.0;
        let Enclosed { outer, attained } = match &mut self.enclosure {
            Enclosure::Grid(grid) => grid.enclose(&self.varying, radius),
            Enclosure::Bernstein(bernstein) => bernstein.enclose(&self.varying, radius),
        };
        let outer = match self.kind {
            RangeKind::Interval => Range { lower: -radius, upper: radius },
            RangeKind::Tight => Range { lower: outer.lower.max(-radius), upper: outer.upper.min(radius) },
        };
        let shifted = |range: Range| Range { lower: middle + range.lower, upper: middle + range.upper };
        Enclosed { outer: shifted(outer), attained: shifted(attained) }
    }
}

/// The tensor grid of Chebyshev extrema and the margins for values between its points.
#[derive(Clone, Debug)]
struct ExtremaGrid {
    /// Evaluation along all axes but the last: rows are points, columns are degrees.
    leading: Separable,
    /// cos(j θ_l) along the last axis for 0 ≤ θ_l ≤ π/2, point after point for each degree j.
    last: Matrix,
    /// Π 1/cos(nᵢ δᵢ).
    widening: f64,
    /// ½ (Σᵢ jᵢ δᵢ)² for each coefficient.
    curvature: Vec<f64>,
    /// Bound on the rounding errors of a value, relative to Σ|c|.
    rounding: f64,
    work: Work,
    /// Interval that contains the values of each row.
    reach: Vec<Range>,
    even: Vec<f64>,
    odd: Vec<f64>,
}

impl ExtremaGrid {
    /// Grid with `intervals[i]` intervals in parameter i, none if its degree is zero.
    fn new(orders: &[usize], intervals: &[usize]) -> Self {
        let spacing = |count: usize| FRAC_PI_2 / count.max(1) as f64;
        let axis = |(&n, &count): (&usize, &usize)| Matrix::new(count + 1, n + 1, |l, j| cos_pi(j * l, count.max(1)));
        let mut axes: Vec<Matrix> = orders.iter().zip(intervals).map(axis).collect();
        axes.pop();
        // Without parameters, the polynomial is constant in an imaginary one.
        let (last, count) = (orders.last().copied().unwrap_or(0), intervals.last().copied().unwrap_or(0));
        let half = count / 2 + 1;
        let mut phases = vec![0.0];
        for (&n, &count) in orders.iter().zip(intervals) {
            phases = phases.iter().flat_map(|&phase| (0..=n).map(move |j| phase + j as f64 * spacing(count))).collect();
        }
        let factors =
            orders.iter().zip(intervals).map(|(&n, &count)| 1.0 / symdiff::math::cos(n as f64 * spacing(count)));
        let operations: usize = orders.iter().map(|n| n + 4).sum();
        Self {
            leading: Separable::new(axes),
            last: Matrix::new(last + 1, half, |j, l| cos_pi(j * l, count.max(1))),
            widening: factors.product(),
            curvature: phases.iter().map(|phase| 0.5 * phase * phase).collect(),
            rounding: 2.0 * operations as f64 * f64::EPSILON,
            work: Work::default(),
            reach: Vec::new(),
            even: vec![0.0; half],
            odd: vec![0.0; half],
        }
    }

    /// Encloses a polynomial with finite coefficients; `radius` = Σ|c|.
    fn enclose(&mut self, coefficients: &[f64], radius: f64) -> Enclosed {
        let on_grid = self.extrema(coefficients);
        let middle = 0.5 * on_grid.lower + 0.5 * on_grid.upper;
        let half = (0.5 * on_grid.upper - 0.5 * on_grid.lower) * self.widening;
        let between: f64 = coefficients.iter().zip(&self.curvature).map(|(c, weight)| c.abs() * weight).sum();
        let rounding = self.rounding * radius;
        let outer = Range {
            lower: (middle - half).max(on_grid.lower - between) - rounding,
            upper: (middle + half).min(on_grid.upper + between) + rounding,
        };
        Enclosed { outer, attained: on_grid }
    }

    /// Least and largest value on the grid. Rows that cannot have one of them are passed over: those in which
    /// c₀ ± Σ|c| lies between values of the others. The first are those in which it reaches the furthest.
    fn extrema(&mut self, coefficients: &[f64]) -> Range {
        let rows = self.leading.apply(coefficients, &mut self.work);
        let rounding = self.rounding;
        let reach = |row: &[f64]| {
            let radius: f64 = row[1..].iter().map(|c| c.abs()).sum();
            let radius = radius + rounding * (row[0].abs() + radius);
            Range { lower: row[0] - radius, upper: row[0] + radius }
        };
        let (mut lowest, mut highest) = ((f64::INFINITY, 0), (f64::NEG_INFINITY, 0));
        self.reach.clear();
        self.reach.extend(rows.chunks_exact(self.last.rows).map(reach));
        for (number, reach) in self.reach.iter().enumerate() {
            lowest = if reach.lower < lowest.0 { (reach.lower, number) } else { lowest };
            highest = if reach.upper > highest.0 { (reach.upper, number) } else { highest };
        }
        let mut found = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };
        let first = [lowest.1, highest.1];
        for (place, number) in first.into_iter().chain(0..self.reach.len()).enumerate() {
            let reach = self.reach[number];
            // Written so that rows with NaN are examined.
            let is_within = found.lower <= reach.lower && reach.upper <= found.upper;
            if is_within || first[..place.min(2)].contains(&number) {
                continue;
            }
            let row = &rows[number * self.last.rows..][..self.last.rows];
            extend(&mut found, row, &self.last, [&mut self.even, &mut self.odd]);
        }
        found
    }
}

/// Extends a range by a row's values along the last axis.
fn extend(found: &mut Range, row: &[f64], last: &Matrix, [even, odd]: [&mut [f64]; 2]) {
    // C_j(−x) = (−1)^j C_j(x): even and odd terms at x ≥ 0 give the values at x and −x.
    even.fill(0.0);
    odd.fill(0.0);
    for (j, (&c, cosines)) in row.iter().zip(last.entries.chunks_exact(last.columns)).enumerate() {
        let part = if j % 2 == 0 { &mut *even } else { &mut *odd };
        part.iter_mut().zip(cosines).for_each(|(part, cosine)| *part += c * cosine);
    }
    for (even, odd) in even.iter().zip(&*odd) {
        let (lower, upper) = (even - odd.abs(), even + odd.abs());
        found.lower = if lower < found.lower { lower } else { found.lower };
        found.upper = if upper > found.upper { upper } else { found.upper };
    }
}

#[cfg(test)]
mod tests {
    use super::super::chebyshev::ChebyshevBasis;
    use super::super::samples::TensorGrid;
    use super::*;
    use proptest::prelude::*;

    fn range(orders: &[usize], kind: RangeKind, coefficients: &[f64]) -> Range {
        PolynomialRange::new(orders, kind).enclose(coefficients).outer
    }

    /// Least and largest value on a dense grid.
    fn dense(orders: &[usize], points: usize, coefficients: &[f64]) -> Range {
        let nodes: Vec<usize> = orders.iter().map(|n| n + 1).collect();
        let grid = TensorGrid::full_factorial(&vec![points; orders.len()]);
        let values = ChebyshevBasis::new(orders, &nodes).on(&grid).values(coefficients);
        let fold = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f).unwrap();
        Range { lower: fold(f64::min), upper: fold(f64::max) }
    }

    #[test]
    fn equation_18_by_hand() {
        // 3 + 2 cos θ − cos 2θ: term by term 3 ± 3. With x = cos θ it is 4 + 2x − 2x²: from 0 at x = −1 to 4.5 at x =
        // ½.
        let c = [3.0, 2.0, -1.0];
        assert_eq!(range(&[2], RangeKind::Interval, &c), Range { lower: 0.0, upper: 6.0 });
        let tight = range(&[2], RangeKind::Tight, &c);
        assert_eq!(tight.lower, 0.0);
        assert!(tight.upper >= 4.5 && tight.upper < 4.5 + 0.005 * 4.5, "{tight:?}");
        // Two parameters: 1 + 2 ξ₁ + 3 ξ₂ + 4 ξ₁ξ₂: 1 ± 9, attained above only: −4 at (1, −1), hence below −5 + 1 − …
        let c = [1.0, 3.0, 2.0, 4.0];
        assert_eq!(range(&[1, 1], RangeKind::Interval, &c), Range { lower: -8.0, upper: 10.0 });
        let tight = range(&[1, 1], RangeKind::Tight, &c);
        assert_eq!(tight.upper, 10.0);
        assert!(tight.lower <= -4.0 && tight.lower > -4.2, "{tight:?}");
    }

    #[test]
    fn ranges_of_constants_are_exact_and_nan_is_unknown() {
        for kind in [RangeKind::Interval, RangeKind::Tight] {
            assert_eq!(range(&[2], kind, &[0.1, 0.0, -0.0]), Range { lower: 0.1, upper: 0.1 });
            assert_eq!(range(&[], kind, &[0.1]), Range { lower: 0.1, upper: 0.1 });
            assert_eq!(range(&[0, 0, 0, 0], kind, &[0.1]), Range { lower: 0.1, upper: 0.1 });
            for hole in 0..3 {
                for bad in [f64::NAN, f64::INFINITY] {
                    let mut c = [1.0, 2.0, 3.0];
                    c[hole] = bad;
                    let unknown = range(&[2], kind, &c);
                    assert!(unknown.lower.is_nan() && unknown.upper.is_nan());
                }
            }
        }
    }

    #[test]
    fn a_small_variation_of_a_large_value_is_not_lost() {
        let tight = range(&[2], RangeKind::Tight, &[1e6, 1e-9, 1e-9]);
        assert!((tight.lower - (1e6 - 1.125e-9)).abs() < 2.4e-10);
    }

    #[test]
    fn a_parameter_of_degree_zero_changes_nothing() {
        let c = [0.3, 1.0, -0.4, 0.2, 0.1, 0.9];
        let (with, without) = (range(&[1, 0, 2], RangeKind::Tight, &c), range(&[1, 2], RangeKind::Tight, &c));
        assert!((with.lower - without.lower).abs() < 1e-14 && (with.upper - without.upper).abs() < 1e-14);
    }

    #[test]
    fn smooth_responses_are_bounded_within_a_thousandth() {
        let basis = ChebyshevBasis::new(&[5, 5], &[6, 6]);
        let grid = basis.grid();
        for f in [
            |x: &[f64]| (2.0 * x[0] + 0.3 * x[1]).sin(),
            |x: &[f64]| 1.0 / (3.0 + x[0] - 0.5 * x[1]),
            |x: &[f64]| (-(x[0] - 0.2) * (x[0] - 0.2) - 0.5 * x[1] * x[1]).exp(),
        ] {
            let values: Vec<f64> = (0..grid.len()).map(|index| f(&grid.sample(index))).collect();
            let mut work = Work::default();
            let c = basis.coefficients(&values, &mut work);
            let (tight, dense) = (range(&[5, 5], RangeKind::Tight, c), dense(&[5, 5], 401, c));
            let excess = tight.width() / dense.width() - 1.0;
            assert!((-1e-12..1e-3).contains(&excess), "{excess:e}");
        }
    }

    fn polynomial() -> impl Strategy<Value = (Vec<usize>, Vec<f64>)> {
        prop::collection::vec(0..6_usize, 1..=3).prop_flat_map(|orders| {
            let count = orders.iter().map(|n| n + 1).product::<usize>();
            (Just(orders), prop::collection::vec(-1.0..1.0_f64, count))
        })
    }

    proptest! {
        #[test]
        fn skipped_rows_have_no_extremum((orders, c) in polynomial()) {
            let mut grid = ExtremaGrid::new(&orders, &intervals(&orders).unwrap());
            let found = grid.extrema(&c);
            let mut all = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };
            let rows = grid.leading.apply(&c, &mut grid.work);
            for row in rows.chunks_exact(grid.last.rows) {
                extend(&mut all, row, &grid.last, [&mut grid.even, &mut grid.odd]);
            }
            prop_assert_eq!(found, all);
        }

        #[test]
        fn tight_range_encloses_within_the_range_of_terms((orders, c) in polynomial()) {
            let dense = dense(&orders, 61, &c);
            let tight = range(&orders, RangeKind::Tight, &c);
            let terms = range(&orders, RangeKind::Interval, &c);
            let rounding = 1e-13;
            prop_assert!(tight.lower <= dense.lower + rounding && dense.upper <= tight.upper + rounding);
            prop_assert!(terms.lower <= tight.lower && tight.upper <= terms.upper);
            // The Ehlich–Zeller factor is 1.0048 for each parameter; the dense grid misses some too.
            prop_assert!(tight.width() <= 1.03 * dense.width() + rounding);

            let mut bernstein = Bernstein::new(&orders);
            let mut varying = c.clone();
            varying[0] = 0.0;
            let radius = varying.iter().map(|c| c.abs()).sum();
            let enclosed = bernstein.enclose(&varying, radius).outer;
            let (lower, upper) = (c[0] + enclosed.lower, c[0] + enclosed.upper);
            prop_assert!(lower <= dense.lower + rounding && dense.upper <= upper + rounding);
            prop_assert!(upper - lower <= 1.03 * dense.width() + rounding);
        }
    }
}
