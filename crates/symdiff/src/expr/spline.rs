//! Natural cubic splines: a table's values as a function with two continuous derivatives.
//!
//! Between neighbouring knots the function is a cubic; its second derivative is zero at the ends, and beyond them it goes on
//! along its tangents, so that it has two continuous derivatives everywhere (de Boor, *A Practical Guide to Splines*, ch. 4).
//!
//! A table is kept for the life of the process, once whatever the number of graphs that use it: an expression refers to it as to
//! any other function, and is copied, compared and hashed like one.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::eval::interval::Interval;

/// A spline; equal if its points are.
#[derive(Clone, Copy)]
pub struct Spline(&'static Pieces);

/// Cubics: below the first knot, between each two, above the last.
struct Pieces {
    knots: Vec<f64>,
    /// Of powers of x − knot; the knot is the one before, but for the first piece.
    cubics: Vec<[f64; 4]>,
}

/// Points that make no spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SplineError {
    /// Fewer than two.
    #[error("a table has at least two points")]
    TooFew,
    /// The point at this place is not a finite number.
    #[error("point {} is not finite", .0 + 1)]
    NotFinite(usize),
    /// The point at this place does not come after the one before.
    #[error("point {} does not come after the one before", .0 + 1)]
    NotAscending(usize),
}

impl Spline {
    /// Through points (x, y), x ascending.
    ///
    /// # Errors
    /// The first point that is wrong.
    pub fn through(points: &[(f64, f64)]) -> Result<Self, SplineError> {
        static KNOWN: OnceLock<Mutex<HashMap<Vec<u64>, Spline>>> = OnceLock::new();
        if points.len() < 2 {
            return Err(SplineError::TooFew);
        }
        for (place, &(x, y)) in points.iter().enumerate() {
            if !(x.is_finite() && y.is_finite()) {
                return Err(SplineError::NotFinite(place));
            }
            if place > 0 && x <= points[place - 1].0 {
                return Err(SplineError::NotAscending(place));
            }
        }
        let bits = points.iter().flat_map(|&(x, y)| [x.to_bits(), y.to_bits()]).collect();
        let known = KNOWN.get_or_init(Mutex::default);
        // A panic while the lock was held leaves the map as it was before.
        let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(*known.entry(bits).or_insert_with(|| Self(Box::leak(Box::new(Pieces::natural(points))))))
    }

    /// The derivative of this order at x.
    pub fn derivative(self, order: u8, x: f64) -> f64 {
        self.taylor(order, x)[0]
    }

    /// Taylor coefficients, of powers 0 to 3, of the derivative of this order about x.
    pub(crate) fn taylor(self, order: u8, x: f64) -> [f64; 4] {
        self.taylor_of(self.0.knots.partition_point(|knot| *knot <= x), order, x)
    }

    /// The same of the cubic of a piece, which x need not be in.
    fn taylor_of(self, piece: usize, order: u8, x: f64) -> [f64; 4] {
        let Pieces { knots, cubics } = self.0;
        let s = x - knots[piece.max(1) - 1];
        let [a, b, c, d] = cubics[piece];
        let about = [a + s * (b + s * (c + s * d)), b + s * (2.0 * c + 3.0 * s * d), c + 3.0 * s * d, d];
        match order {
            0 => about,
            1 => [about[1], 2.0 * about[2], 3.0 * about[3], 0.0],
            2 => [2.0 * about[2], 6.0 * about[3], 0.0, 0.0],
            3 => [6.0 * about[3], 0.0, 0.0, 0.0],
            _ => [0.0; 4],
        }
    }

    /// What the derivative of this order may be over an interval.
    pub(crate) fn enclose(self, order: u8, x: Interval) -> Interval {
        if !x.magnitude().is_finite() {
            return Interval::ENTIRE;
        }
        let knots = &self.0.knots;
        let pieces =
            knots.partition_point(|knot| *knot <= x.lower())..=knots.partition_point(|knot| *knot <= x.upper());
        let of_piece = |piece: usize| {
            let [first, last] = [piece.wrapping_sub(1), piece].map(|knot| knots.get(knot).copied());
            let (first, last) = (x.lower().max(first.unwrap_or(x.lower())), x.upper().min(last.unwrap_or(x.upper())));
            let middle = 0.5 * (first + last);
            let from = Interval::new(first, last) - Interval::point(middle);
            let [a, b, c, d] = self.taylor_of(piece, order, middle).map(Interval::point);
            let value = a + from * (b + from * (c + from * d));
            // The coefficients are rounded.
            let allowance = 1e-14 * value.magnitude();
            Interval::new(value.lower() - allowance, value.upper() + allowance)
        };
        let ranges = pieces.map(of_piece);
        ranges
            .reduce(|a, b| Interval::new(a.lower().min(b.lower()), a.upper().max(b.upper())))
            .unwrap_or(Interval::ENTIRE)
    }

    /// The first and the last x.
    pub fn range(self) -> (f64, f64) {
        let knots = &self.0.knots;
        (knots[0], knots[knots.len() - 1])
    }
}

impl Pieces {
    /// The second derivatives m solve hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (slopeᵢ − slopeᵢ₋₁), m = 0 at the ends.
    fn natural(points: &[(f64, f64)]) -> Self {
        let n = points.len();
        let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        let slopes: Vec<f64> = points.windows(2).zip(&widths).map(|(pair, h)| (pair[1].1 - pair[0].1) / h).collect();
        // Thomas' elimination: diagonal and right side.
        let (mut diagonal, mut right) = (vec![1.0; n], vec![0.0; n]);
        for i in 1..n - 1 {
            let factor = if i > 1 { widths[i - 1] / diagonal[i - 1] } else { 0.0 };
            diagonal[i] = 2.0 * (widths[i - 1] + widths[i]) - factor * widths[i - 1];
            right[i] = 6.0 * (slopes[i] - slopes[i - 1]) - factor * right[i - 1];
        }
        let mut second = vec![0.0; n];
        for i in (1..n - 1).rev() {
            second[i] = (right[i] - widths[i] * second[i + 1]) / diagonal[i];
        }
        let mut cubics = Vec::with_capacity(n + 1);
        for i in 0..n - 1 {
            let (h, m, next) = (widths[i], second[i], second[i + 1]);
            let slope = slopes[i] - h * (2.0 * m + next) / 6.0;
            if i == 0 {
                cubics.push([points[0].1, slope, 0.0, 0.0]);
            }
            cubics.push([points[i].1, slope, 0.5 * m, (next - m) / (6.0 * h)]);
        }
        let (h, m) = (widths[n - 2], second[n - 2]);
        cubics.push([points[n - 1].1, slopes[n - 2] + h * m / 6.0, 0.0, 0.0]);
        Self { knots: points.iter().map(|point| point.0).collect(), cubics }
    }
}

impl PartialEq for Spline {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Spline {}

impl Hash for Spline {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::hash(self.0, state);
    }
}

impl std::fmt::Debug for Spline {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Spline({} points)", self.0.knots.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::jet::{JetScratch, JetSpace};
    use crate::{Graph, Unary};

    fn sine() -> Spline {
        let points: Vec<_> =
            (0..=40).map(|i| 0.05 * f64::from(i) * std::f64::consts::PI).map(|x| (x, x.sin())).collect();
        Spline::through(&points).unwrap()
    }

    #[test]
    fn it_interpolates_and_converges_with_order_four() {
        let error = |n: i32| {
            let points: Vec<_> =
                (0..=n).map(|i| f64::from(i) / f64::from(n) * std::f64::consts::PI).map(|x| (x, x.sin())).collect();
            let spline = Spline::through(&points).unwrap();
            assert!(points.iter().all(|&(x, y)| (spline.derivative(0, x) - y).abs() < 1e-15));
            (0..1000)
                .map(|i| 0.0031 * f64::from(i))
                .map(|x| (spline.derivative(0, x) - x.sin()).abs())
                .fold(0.0, f64::max)
        };
        // The sine has no curvature at the ends, as a natural spline's.
        let ratio = error(10) / error(20);
        assert!((ratio - 16.0).abs() < 2.0, "{ratio}");
    }

    #[test]
    fn two_derivatives_are_continuous_everywhere() {
        let spline = Spline::through(&[(0.0, 1.0), (0.5, -2.0), (2.0, 0.3), (3.0, 5.0)]).unwrap();
        for knot in [0.0, 0.5, 2.0, 3.0] {
            for order in 0..=2 {
                let [below, above] = [-1e-12, 1e-12].map(|d| spline.derivative(order, knot + d));
                assert!((below - above).abs() < 1e-9, "order {order} at {knot}: {below} {above}");
            }
        }
        assert_eq!(spline.derivative(2, -1.0), 0.0);
        assert_eq!(spline.range(), (0.0, 3.0));
    }

    #[test]
    fn a_line_stays_one() {
        let spline = Spline::through(&[(-1.0, 3.0), (0.5, 0.0), (4.0, -7.0)]).unwrap();
        for x in [-9.0, -1.0, 0.1, 2.0, 4.0, 100.0] {
            assert!((spline.derivative(0, x) - (1.0 - 2.0 * x)).abs() < 1e-12 * (1.0 + x.abs()));
            assert!((spline.derivative(1, x) + 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn symbolic_derivatives_and_jets_are_the_splines_own() {
        let (spline, mut g) = (sine(), Graph::new());
        let x = g.symbol("x");
        let value = g.unary(Unary::Spline(spline, 0), x);
        assert_eq!(value, g.unary(Unary::Spline(sine(), 0), x));
        let slope = g.derivative(value, x);
        let at = |g: &Graph, expr| g.evaluate(&[expr], |_| 1.3)[0];
        assert_eq!(at(&g, slope), spline.derivative(1, 1.3));
        // h³/24 of the fourth derivative (de Boor).
        assert!((at(&g, slope) - 1.3_f64.cos()).abs() < 1.7e-4);
        let space = JetSpace::new(1, 4);
        let mut scratch = JetScratch::new(&space);
        let (mut a, mut out) = (vec![0.0; space.len()], vec![0.0; space.len()]);
        space.variable(0, 1.3, 2.0, &mut a);
        a[2] = 0.5;
        space.unary(Unary::Spline(spline, 0), &a, &mut out, &mut scratch);
        let inside = |xi: f64| spline.derivative(0, 1.3 + 2.0 * xi + 0.5 * xi * xi);
        let polynomial = |xi: f64| out.iter().rev().fold(0.0, |sum, c| sum * xi + c);
        for xi in [-1e-2, 1e-2] {
            assert!((inside(xi) - polynomial(xi)).abs() < 1e-9, "{} {}", inside(xi), polynomial(xi));
        }
    }

    #[test]
    fn wrong_points_are_told() {
        assert_eq!(Spline::through(&[(0.0, 1.0)]), Err(SplineError::TooFew));
        assert_eq!(Spline::through(&[(0.0, 1.0), (0.0, 2.0)]), Err(SplineError::NotAscending(1)));
        assert_eq!(Spline::through(&[(0.0, f64::NAN), (1.0, 2.0)]), Err(SplineError::NotFinite(0)));
    }
}
