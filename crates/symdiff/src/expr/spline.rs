//! Natural cubic splines: a table's values as a function with two continuous derivatives.
//!
//! Between neighbouring knots the function is a cubic; its second derivative is zero at the ends, and beyond them it
//! continues along its tangents, so that it has two continuous derivatives everywhere (de Boor, *A Practical Guide to
//! Splines*, ch. 4). A periodic one repeats itself instead, with two continuous derivatives at its ends.
//!
//! A table is stored for the life of the process, once for all graphs that use it: an expression refers to it as to any
//! other function, and is copied, compared and hashed like one.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::sync::{Mutex, OnceLock, PoisonError};

use super::spline_error::SplineError;
use super::spline_pieces::Pieces;
use crate::eval::interval::Interval;

/// A spline; equal if its points are.
#[derive(Clone, Copy)]
pub struct Spline(&'static Pieces);

/// Interpolation between the points.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Course {
    /// With two continuous derivatives.
    Natural,
    /// Like `Natural`, but repeats itself beyond its ends.
    Periodic,
    /// By straight lines.
    Linear,
}

/// Bits of the points' coordinates, and the course between them.
type Points = (Vec<u64>, Course);

/// Bits of knots and cubics, and whether they repeat.
type Content = (Vec<u64>, bool);

impl Spline {
    /// The spline through points (x, y), x ascending.
    ///
    /// # Errors
    /// The first point that is wrong.
    pub fn through(points: &[(f64, f64)]) -> Result<Self, SplineError> {
        Self::of(points, Course::Natural)
    }

    /// The periodic spline through points (x, y), x ascending, over a period from the first to the last, which have the
    /// same y.
    ///
    /// # Errors
    /// The first point that is wrong.
    pub fn periodic(points: &[(f64, f64)]) -> Result<Self, SplineError> {
        Self::of(points, Course::Periodic)
    }

    /// Straight lines from point (x, y) to point, x ascending: the derivatives jump there.
    ///
    /// # Errors
    /// The first point that is wrong.
    pub fn linear(points: &[(f64, f64)]) -> Result<Self, SplineError> {
        Self::of(points, Course::Linear)
    }

    fn of(points: &[(f64, f64)], course: Course) -> Result<Self, SplineError> {
        static KNOWN: OnceLock<Mutex<HashMap<Points, Spline>>> = OnceLock::new();
        if points.len() < 2 {
            return Err(SplineError::TooFew);
        }
        for (index, &(x, y)) in points.iter().enumerate() {
            if !(x.is_finite() && y.is_finite()) {
                return Err(SplineError::NotFinite(index));
            }
            if index > 0 && x <= points[index - 1].0 {
                return Err(SplineError::NotAscending(index));
            }
        }
        if course == Course::Periodic && points[0].1 != points[points.len() - 1].1 {
            return Err(SplineError::NotPeriodic);
        }
        let bits = points.iter().flat_map(|&(x, y)| [x.to_bits(), y.to_bits()]).collect();
        let known = KNOWN.get_or_init(Mutex::default);
        // A panic during the lock leaves the map unchanged.
        let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
        let pieces = || match course {
            Course::Natural => Pieces::natural(points),
            Course::Periodic => Pieces::periodic(points),
            Course::Linear => Pieces::with_second(points, &vec![0.0; points.len()], false),
        };
        Ok(*known.entry((bits, course)).or_insert_with(|| Self::kept(pieces())))
    }

    /// The spline with these knots and cubics, as in [`pieces`](Self::pieces); `None` if the knots do not ascend, or
    /// the number of cubics is not one more.
    pub fn of_pieces(knots: Vec<f64>, cubics: Vec<[f64; 4]>, periodic: bool) -> Option<Self> {
        let is_sound = knots.len() >= 2
            && knots.windows(2).all(|pair| pair[0] < pair[1])
            && cubics.len() == knots.len() + 1
            && knots.iter().chain(cubics.as_flattened()).all(|number| number.is_finite());
        is_sound.then(|| Self::kept(Pieces { knots, cubics, periodic, jumps: OnceLock::new() }))
    }

    /// The stored spline with these pieces.
    fn kept(pieces: Pieces) -> Self {
        static KNOWN: OnceLock<Mutex<HashMap<Content, Spline>>> = OnceLock::new();
        let numbers = pieces.knots.iter().chain(pieces.cubics.as_flattened());
        let bits = numbers.map(|number| number.to_bits()).collect();
        let mut known = KNOWN.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
        *known.entry((bits, pieces.periodic)).or_insert_with(|| Self(Box::leak(Box::new(pieces))))
    }

    /// Knots, cubics (below the first knot, between each two, above the last; in powers of x minus the knot before),
    /// and whether it repeats.
    pub fn pieces(self) -> (&'static [f64], &'static [[f64; 4]], bool) {
        (&self.0.knots, &self.0.cubics, self.0.periodic)
    }

    pub(super) fn jumps(self) -> &'static OnceLock<[Option<f64>; 4]> {
        &self.0.jumps
    }

    /// The derivative of this order at x.
    pub fn derivative(self, order: u8, x: f64) -> f64 {
        self.taylor(order, x)[0]
    }

    /// Taylor coefficients, of powers 0 to 3, of the derivative of this order about x.
    pub(crate) fn taylor(self, order: u8, x: f64) -> [f64; 4] {
        let x = if self.0.periodic { x - self.shift(x) } else { x };
        self.taylor_of(self.piece(x), order, x)
    }

    /// The cubic at x, and the origin of its powers.
    pub(crate) fn cubic_at(self, x: f64) -> (f64, [f64; 4]) {
        let shift = if self.0.periodic { self.shift(x) } else { 0.0 };
        let piece = self.piece(x - shift);
        (self.0.knots[piece.max(1) - 1] + shift, self.0.cubics[piece])
    }

    /// The piece that contains a number.
    fn piece(self, x: f64) -> usize {
        let piece = self.0.knots.partition_point(|knot| *knot <= x);
        // Rounding at an end of the period belongs to the piece there.
        if self.0.periodic { piece.clamp(1, self.0.knots.len() - 1) } else { piece }
    }

    /// Length of the periods between a number and the first period.
    fn shift(self, x: f64) -> f64 {
        let (first, last) = self.range();
        (last - first) * ((x - first) / (last - first)).floor()
    }

    /// The same for the cubic of a given piece, even if x is not in it.
    fn taylor_of(self, piece: usize, order: u8, x: f64) -> [f64; 4] {
        let Pieces { knots, cubics, .. } = self.0;
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

    /// Enclosure of the derivative of this order over an interval.
    pub fn enclose(self, order: u8, x: Interval) -> Interval {
        if !x.magnitude().is_finite() {
            return Interval::ENTIRE;
        }
        if self.0.periodic {
            return self.enclose_periodic(order, x);
        }
        self.enclose_pieces(order, x)
    }

    /// The same for a periodic one: over a whole period, or over the parts of one that the interval covers.
    fn enclose_periodic(self, order: u8, x: Interval) -> Interval {
        let (first, last) = self.range();
        let whole = || self.enclose_pieces(order, Interval::new(first, last));
        let shift = self.shift(x.lower());
        // The shift is rounded; a value that it moves out of the period is near its end.
        let slack = 4.0 * f64::EPSILON * x.magnitude().max(shift.abs());
        let (lower, upper) = (x.lower() - shift - slack, x.upper() - shift + slack);
        if upper - lower >= last - first {
            return whole();
        }
        if lower >= first && upper <= last {
            return self.enclose_pieces(order, Interval::new(lower, upper));
        }
        let (below, above) =
            if lower < first { (lower + (last - first), upper) } else { (lower, upper - (last - first)) };
        let [a, b] = [Interval::new(below.clamp(first, last), last), Interval::new(first, above.clamp(first, last))]
            .map(|part| self.enclose_pieces(order, part));
        Interval::new(a.lower().min(b.lower()), a.upper().max(b.upper()))
    }

    fn enclose_pieces(self, order: u8, x: Interval) -> Interval {
        let knots = &self.0.knots;
        let pieces = self.piece(x.lower())..=self.piece(x.upper());
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
    fn spline_interpolates_and_converges_with_order_four() {
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
        // The curvature of the sine is zero at the ends, like a natural spline's.
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
    fn periodic_spline_repeats_smoothly() {
        let wave = |x: f64| 2.0 + x.sin() + 0.3 * (2.0 * x).cos();
        let error = |n: i32| {
            let period = std::f64::consts::TAU;
            let mut points: Vec<_> =
                (0..=n).map(|i| f64::from(i) / f64::from(n) * period).map(|x| (x, wave(x))).collect();
            let last = points.len() - 1;
            points[last].1 = points[0].1;
            let spline = Spline::periodic(&points).unwrap();
            for order in 0..=2 {
                let [below, above] = [-1e-9, 1e-9].map(|d| spline.derivative(order, period + d));
                assert!((below - above).abs() < 1e-7, "order {order}: {below} {above}");
            }
            let at = |i: i32| 0.0131 * f64::from(i);
            (-2000..2000).map(at).map(|x| (spline.derivative(0, x) - wave(x)).abs()).fold(0.0, f64::max)
        };
        // Fourth order up to the ends, since a periodic spline has none.
        let ratio = error(16) / error(32);
        assert!((ratio - 16.0).abs() < 2.0, "{ratio}");
        assert_eq!(Spline::periodic(&[(0.0, 1.0), (1.0, 2.0)]), Err(SplineError::NotPeriodic));
        let constant = Spline::periodic(&[(0.0, 1.0), (1.0, 1.0)]).unwrap();
        assert_eq!((constant.derivative(0, 7.3), constant.derivative(1, 7.3)), (1.0, 0.0));
        assert_ne!(constant, Spline::through(&[(0.0, 1.0), (1.0, 1.0)]).unwrap());
    }

    #[test]
    fn periodic_spline_is_enclosed() {
        let spline = Spline::periodic(&[(0.5, 1.0), (1.0, -2.0), (2.25, 0.3), (3.0, 1.0)]).unwrap();
        for (lower, width) in [(0.6, 0.1), (2.9, 0.3), (-7.1, 0.9), (40.3, 2.4), (3.0, 0.2), (1.7, 9.0), (0.5, 2.5)] {
            for order in 0..=3 {
                let range = spline.enclose(order, Interval::new(lower, lower + width));
                for part in 0..=100 {
                    let value = spline.derivative(order, lower + width * f64::from(part) / 100.0);
                    assert!(range.contains(value), "order {order} of {lower} + {width}: {range:?} {value}");
                }
                let size = spline.enclose(order, Interval::new(0.5, 3.0));
                assert!(range.upper() - range.lower() <= (size.upper() - size.lower()) * (1.0 + 1e-9));
            }
        }
    }

    #[test]
    fn spline_through_a_line_is_the_line() {
        let spline = Spline::through(&[(-1.0, 3.0), (0.5, 0.0), (4.0, -7.0)]).unwrap();
        for x in [-9.0, -1.0, 0.1, 2.0, 4.0, 100.0] {
            assert!((spline.derivative(0, x) - (1.0 - 2.0 * x)).abs() < 1e-12 * (1.0 + x.abs()));
            assert!((spline.derivative(1, x) + 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn symbolic_derivatives_and_jets_match_the_spline() {
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
    fn invalid_points_are_reported() {
        assert_eq!(Spline::through(&[(0.0, 1.0)]), Err(SplineError::TooFew));
        assert_eq!(Spline::through(&[(0.0, 1.0), (0.0, 2.0)]), Err(SplineError::NotAscending(1)));
        assert_eq!(Spline::through(&[(0.0, f64::NAN), (1.0, 2.0)]), Err(SplineError::NotFinite(0)));
    }
}
