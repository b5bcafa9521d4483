//! The range of a polynomial of many parameters: Bernstein form with branch and bound.
//!
//! On a box, a polynomial lies between the least and the largest of its Bernstein coefficients, and takes the values of
//! those at the corners. Halving the box (de Casteljau) brings both together quadratically. Unsplit, the form is often
//! worse than Σ|c|; it is the splitting that makes it tight. The box with the highest bound is split first, so at any
//! time that bound holds for the whole, and the largest corner seen is attained.

use std::collections::BinaryHeap;

use super::range::{Enclosed, Range};
use super::ranked::Ranked;
use super::tensor::{Matrix, Separable, Work};
use super::tuning::TUNING;

/// Bounds polynomials of one shape.
#[derive(Clone, Debug)]
pub(super) struct Bernstein {
    orders: Vec<usize>,
    conversion: Separable,
    /// Bound on the rounding errors of a coefficient, relative to Σ|c|.
    rounding: f64,
    max_splits: usize,
    work: Work,
    /// The polynomial's coefficients on parts of the domain, by the largest of each.
    boxes: BinaryHeap<Ranked<Vec<f64>>>,
    /// Coefficients of boxes that are done with, to be used again.
    spare: Vec<Vec<f64>>,
}

impl Bernstein {
    pub(super) fn new(orders: &[usize]) -> Self {
        let axes: Vec<Matrix> = orders.iter().map(|&n| from_chebyshev(n)).collect();
        let largest = |matrix: &Matrix| matrix.entries.iter().fold(1.0_f64, |most, entry| most.max(entry.abs()));
        let operations: usize = orders.iter().map(|n| 2 * n + 4).sum();
        let size: usize = orders.iter().map(|n| n + 1).product();
        let per_split = size * (orders.iter().max().copied().unwrap_or(0) + 2);
        Self {
            orders: orders.to_vec(),
            rounding: operations as f64 * f64::EPSILON * axes.iter().map(largest).product::<f64>(),
            max_splits: (TUNING.bernstein_work / per_split).max(TUNING.bernstein_splits),
            conversion: Separable::new(axes),
            work: Work::default(),
            boxes: BinaryHeap::new(),
            spare: Vec::new(),
        }
    }

    /// Encloses a polynomial with finite Chebyshev coefficients; `radius` = Σ|c|.
    pub(super) fn enclose(&mut self, coefficients: &[f64], radius: f64) -> Enclosed {
        let mut attained = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };
        let upper = self.maximum(coefficients, 1.0, &mut attained);
        attained = Range { lower: -attained.upper, upper: -attained.lower };
        let lower = -self.maximum(coefficients, -1.0, &mut attained);
        let rounding = self.rounding * radius;
        let attained = Range { lower: -attained.upper, upper: -attained.lower };
        Enclosed { outer: Range { lower: lower - rounding, upper: upper + rounding }, attained }
    }

    /// An upper bound of sign · p; `attained` widens by the values evaluated.
    fn maximum(&mut self, coefficients: &[f64], sign: f64, attained: &mut Range) -> f64 {
        let mut whole = self.spare.pop().unwrap_or_default();
        whole.clear();
        whole.extend(self.conversion.apply(coefficients, &mut self.work).iter().map(|b| sign * b));
        self.keep(whole, attained);
        let mut splits = 0;
        while let Some(part) = self.boxes.pop() {
            let close = part.rank - attained.upper <= TUNING.bernstein_tolerance * attained.width();
            if close || splits == self.max_splits {
                let rest = self.boxes.drain().map(|part| part.item);
                self.spare.extend(rest.chain([part.item]));
                return part.rank.max(attained.upper);
            }
            splits += 1;
            let mut right = part.item;
            let mut left = self.spare.pop().unwrap_or_default();
            halve(&self.orders, self.axis_to_split(&right), &mut right, &mut left);
            self.keep(left, attained);
            self.keep(right, attained);
        }
        attained.upper // every part was bounded by a value attained elsewhere
    }

    /// Looks at a part's corners, and keeps it if more may be found in it.
    fn keep(&mut self, coefficients: Vec<f64>, attained: &mut Range) {
        for corner in corners(&self.orders) {
            let value = coefficients[corner];
            attained.lower = attained.lower.min(value);
            attained.upper = attained.upper.max(value);
        }
        let bound = coefficients.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if bound > attained.upper {
            self.boxes.push(Ranked { rank: bound, item: coefficients });
        } else {
            self.spare.push(coefficients);
        }
    }

    /// Axis along which the polynomial bends most: that with the largest second difference n (n − 1) |Δ²b|, which keeps
    /// coefficients and values apart.
    fn axis_to_split(&self, coefficients: &[f64]) -> usize {
        let (mut chosen, mut most) = (0, -1.0);
        let mut inner = coefficients.len();
        for (axis, &n) in self.orders.iter().enumerate() {
            let block = inner;
            inner /= n + 1;
            let mut bend = 0.0_f64;
            for lines in coefficients.chunks_exact(block) {
                let triples = lines.iter().zip(lines.iter().skip(inner)).zip(lines.iter().skip(2 * inner));
                bend = triples.fold(bend, |bend, ((a, b), c)| bend.max((a - 2.0 * b + c).abs()));
            }
            // A linear axis bends only together with others: it comes last, but it comes.
            let weighted = if n >= 2 { (n * (n - 1)) as f64 * bend } else { 0.0 };
            let weighted = weighted + if n > 0 { 1e-3 * self.slope(coefficients, block, inner) } else { -1.0 };
            if weighted > most {
                (chosen, most) = (axis, weighted);
            }
        }
        chosen
    }

    /// Largest first difference along an axis.
    fn slope(&self, coefficients: &[f64], block: usize, inner: usize) -> f64 {
        let pairs = coefficients.chunks_exact(block).flat_map(|lines| lines.iter().zip(lines.iter().skip(inner)));
        pairs.fold(0.0, |most, (a, b)| (b - a).abs().max(most))
    }
}

/// Positions of the corner coefficients: each index first or last.
fn corners(orders: &[usize]) -> impl Iterator<Item = usize> + '_ {
    (0..1_usize << orders.len()).map(|choice| {
        let index = |position, (axis, n): (usize, &usize)| position * (n + 1) + (choice >> axis & 1) * n;
        orders.iter().enumerate().fold(0, index)
    })
}

/// Splits a part in the middle of an axis: `right` goes in whole and comes out as the upper half, `left` as the lower.
pub(super) fn halve(orders: &[usize], axis: usize, right: &mut [f64], left: &mut Vec<f64>) {
    left.clear();
    left.resize(right.len(), 0.0);
    let n = orders[axis];
    let inner: usize = orders[axis + 1..].iter().map(|n| n + 1).product();
    let block = (n + 1) * inner;
    for (right, left) in right.chunks_exact_mut(block).zip(left.chunks_exact_mut(block)) {
        for level in 0..=n {
            left[level * inner..][..inner].copy_from_slice(&right[..inner]);
            for index in 0..(n - level) * inner {
                right[index] = 0.5 * (right[index] + right[index + inner]);
            }
        }
    }
}

/// Column j: Bernstein coefficients of C_j in degree n on [−1, 1].
pub(super) fn from_chebyshev(n: usize) -> Matrix {
    let columns: Vec<Vec<f64>> = (0..=n).map(|j| elevated(chebyshev_in_its_own_degree(j), n)).collect();
    Matrix::new(n + 1, n + 1, |i, j| columns[j][i])
}

/// (−1)^(j−i) C(2j, 2i)/C(j, i), i = 0…j.
fn chebyshev_in_its_own_degree(j: usize) -> Vec<f64> {
    let mut coefficients = vec![if j.is_multiple_of(2) { 1.0 } else { -1.0 }];
    for i in 0..j {
        // C(2j, 2i+2)/C(2j, 2i) · C(j, i)/C(j, i+1) = (2j − 2i − 1)/(2i + 1)
        let ratio = (2 * j - 2 * i - 1) as f64 / (2 * i + 1) as f64;
        coefficients.push(-coefficients[i] * ratio);
    }
    coefficients
}

/// The same polynomial in degree n.
fn elevated(mut coefficients: Vec<f64>, n: usize) -> Vec<f64> {
    while coefficients.len() <= n {
        let degree = coefficients.len();
        let share = |i: usize| i as f64 / degree as f64;
        let middle = (1..degree).map(|i| share(i) * coefficients[i - 1] + (1.0 - share(i)) * coefficients[i]);
        coefficients = [coefficients[0]].into_iter().chain(middle).chain([coefficients[degree - 1]]).collect();
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chebyshev_polynomials_in_bernstein_form() {
        // C₂ = 2x² − 1: 1, −3, 1; in degree 3: 1, −5/3, −5/3, 1.
        assert_eq!(chebyshev_in_its_own_degree(2), [1.0, -3.0, 1.0]);
        let cubic = elevated(vec![1.0, -3.0, 1.0], 3);
        for (b, expected) in cubic.iter().zip([1.0, -5.0 / 3.0, -5.0 / 3.0, 1.0]) {
            assert!((b - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn halves_agree_with_the_whole() {
        // x² on [0, 1] is 0, 0, 1; on its halves 0, 0, 1/4 and 1/4, 1/2, 1.
        let (mut right, mut left) = (vec![0.0, 0.0, 1.0], Vec::new());
        halve(&[2], 0, &mut right, &mut left);
        assert_eq!((left, right), (vec![0.0, 0.0, 0.25], vec![0.25, 0.5, 1.0]));
        let (mut right, mut left) = (vec![1.0, 2.0, 3.0, 4.0], Vec::new());
        halve(&[1, 1], 1, &mut right, &mut left);
        assert_eq!((left, right), (vec![1.0, 1.5, 3.0, 3.5], vec![1.5, 2.0, 3.5, 4.0]));
    }

    #[test]
    fn five_parameters() {
        // Σ ξᵢ² − ξ₁ξ₂ξ₃ with C₂ = 2ξ² − 1 stored in degree 2: range [0, 6] (corners with ξ₁ξ₂ξ₃ = −1), centre 0.
        let orders = [2; 5];
        let mut c = vec![0.0; 243];
        for axis in 0..5 {
            c[2 * 3_usize.pow(axis)] = 0.5;
        }
        c[81 + 27 + 9] = -1.0;
        let range = Bernstein::new(&orders).enclose(&c, 3.5).outer;
        // Without the constant 2.5.
        assert!(range.lower <= -2.5 && range.lower > -2.5 - 0.0061, "{range:?}");
        assert!(range.upper >= 3.5 && range.upper < 3.5 + 0.0061, "{range:?}");
    }
}
