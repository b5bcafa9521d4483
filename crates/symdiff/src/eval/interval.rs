//! Intervals that enclose: the result of an operation contains the exact results for all members of its operands.
//!
//! IEEE operations are correct to half a unit in the last place, so that the neighbours of a computed number enclose
//! the exact one; no rounding mode is switched. A result without a bound (a quotient by an interval with zero in it,
//! the root of a negative number) is [`Interval::ENTIRE`]: nothing is known, and nothing false is claimed. Sine and
//! cosine are summed here from their series, because the errors of a library's are measured rather than proven.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// [lower, upper]; infinite if there is no bound, never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
}

/// Size from which the multiple of π/2 has too many bits for the reduction's exact products.
const LARGE: f64 = 1e5;

/// π/2 = the sum of three, the last between its neighbours (see [`sincos`](crate::eval::sincos)).
const QUADRANTS: [u64; 3] = [0x3FF9_21FB_5440_0000, 0x3DD0_B461_1A60_0000, 0x3BA3_198A_2E03_7073];

/// Terms of the series for |x| < 0.8; the remainder is below 0.8²¹/21! < 2e-22.
const TERMS: i32 = 10;
const SERIES_TAIL: f64 = 2e-22;

/// Least size of an end that is not zero: 2⁻⁵⁰⁰. Products of two ends are then not subnormal, which would cost a
/// processor more than a hundred cycles each.
pub(super) const TINY: f64 = f64::from_bits((1023 - 500) << 52);

impl Interval {
    /// All numbers.
    pub const ENTIRE: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// One number; all numbers for NaN.
    #[inline]
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// The interval between two numbers, the smaller first; all numbers if either is NaN.
    #[inline]
    pub fn new(lower: f64, upper: f64) -> Self {
        if lower <= upper { Self { lower, upper } } else { Self::ENTIRE }
    }

    /// Computed ends, moved outward by one place, or to zero or [`TINY`].
    #[inline]
    fn outward(lower: f64, upper: f64) -> Self {
        Self::new(-Self::above(-lower), Self::above(upper))
    }

    /// A number no smaller than the exact one: a negative computed number was not positive before its rounding.
    #[inline]
    fn above(computed: f64) -> f64 {
        match computed {
            _ if computed.abs() >= TINY => computed.next_up(),
            _ if computed < 0.0 => 0.0,
            _ if computed.is_nan() => computed,
            _ => TINY,
        }
    }

    /// Lower end.
    pub fn lower(self) -> f64 {
        self.lower
    }

    /// Upper end.
    pub fn upper(self) -> f64 {
        self.upper
    }

    /// Whether a number lies within.
    pub fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Largest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lower.abs().max(self.upper.abs())
    }

    /// A member near the middle; 0 for [`ENTIRE`](Self::ENTIRE).
    pub fn middle(self) -> f64 {
        let middle = 0.5 * self.lower + 0.5 * self.upper;
        if middle.is_finite() { middle.clamp(self.lower, self.upper) } else { 0.0 }
    }

    /// Largest distance of a member from `value`, rounded up.
    pub fn radius_about(self, value: f64) -> f64 {
        (self - Self::point(value)).magnitude()
    }

    /// The smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.lower.min(other.lower), self.upper.max(other.upper))
    }

    /// a²: never negative.
    pub fn square(self) -> Self {
        let product = self * self;
        Self::new(product.lower.max(0.0), product.upper.max(0.0))
    }

    /// √a; all numbers if a member is negative.
    pub fn sqrt(self) -> Self {
        if self.lower < 0.0 {
            return Self::ENTIRE;
        }
        let root = Self::outward(self.lower.sqrt(), self.upper.sqrt());
        Self::new(root.lower.max(0.0), root.upper)
    }

    /// (sin a, cos a).
    pub fn sin_cos(self) -> (Self, Self) {
        let whole = Self::new(-1.0, 1.0);
        let middle = self.middle();
        if !(self.lower.is_finite() && self.upper.is_finite()) || middle.abs() >= LARGE {
            return (whole, whole);
        }
        // Neither changes faster than the argument.
        let radius = self.radius_about(middle);
        let spread = Self::new(-radius, radius);
        let (sine, cosine) = sin_cos_of(middle);
        let within = |value: Self| {
            let value = value + spread;
            Self::new(value.lower.max(-1.0), value.upper.min(1.0))
        };
        (within(sine), within(cosine))
    }
}

/// Enclosures of (sin x, cos x), |x| < [`LARGE`].
fn sin_cos_of(x: f64) -> (Interval, Interval) {
    let n = (x * std::f64::consts::FRAC_2_PI).round();
    let [first, second, third] = QUADRANTS.map(f64::from_bits);
    // Exact, as in `sincos`: n times the first 33 bits, the remainder of x, and n times the next 33 bits.
    let (left, second) = (x - n * first, n * second);
    let third = if n == 0.0 { Interval::point(0.0) } else { Interval::outward(third, third) };
    let rest = Interval::point(left) - Interval::point(second) - Interval::point(n) * third;
    // |rest| < 0.8, and the terms of the alternating series decrease: the remainder is below the first omitted term.
    let square = rest.square();
    let tail = Interval::new(-SERIES_TAIL, SERIES_TAIL);
    let one = Interval::point(1.0);
    let (mut sine, mut cosine) = (one, one);
    for term in (1..TERMS).rev() {
        let even = f64::from(2 * term);
        sine = one - square * sine / Interval::point(even * (even + 1.0));
        cosine = one - square * cosine / Interval::point(even * (even - 1.0));
    }
    let (sine, cosine) = (rest * sine + tail, cosine + tail);
    match n.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::outward(self.lower + other.lower, self.upper + other.upper)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::outward(self.lower - other.upper, self.upper - other.lower)
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.upper, -self.lower)
    }
}

/// Least and largest of four candidates; all numbers if one is NaN.
#[inline]
fn hull([a, b, c, d]: [f64; 4]) -> Interval {
    if a.is_nan() | b.is_nan() | c.is_nan() | d.is_nan() {
        return Interval::ENTIRE;
    }
    // Without NaN, one instruction each. Ends that are zero move outward, whatever their sign.
    let least = |a: f64, b: f64| if a < b { a } else { b };
    let largest = |a: f64, b: f64| if a > b { a } else { b };
    Interval::outward(least(least(a, b), least(c, d)), largest(largest(a, b), largest(c, d)))
}

impl Mul for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let Self { lower: a, upper: b } = self;
        let Self { lower: c, upper: d } = other;
        hull([a * c, a * d, b * c, b * d])
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.contains(0.0) {
            return Self::ENTIRE;
        }
        let Self { lower: a, upper: b } = self;
        let Self { lower: c, upper: d } = other;
        hull([a / c, a / d, b / c, b / d])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// An interval and a number in it.
    fn member() -> impl Strategy<Value = (Interval, f64)> {
        (-1e3..1e3_f64, prop_oneof![Just(0.0), 0.0..1e-9_f64, 0.0..10.0_f64], 0.0..=1.0_f64).prop_map(
            |(a, width, at)| {
                let interval = Interval::new(a, a + width);
                (interval, (a + at * width).clamp(interval.lower(), interval.upper()))
            },
        )
    }

    /// a + b − rounded sum, exactly (Knuth).
    fn lost_in_sum(a: f64, b: f64) -> f64 {
        let sum = a + b;
        let share = sum - a;
        (a - (sum - share)) + (b - share)
    }

    proptest! {
        #[test]
        fn operations_enclose(((x, a), (y, b)) in (member(), member())) {
            prop_assert!((x + y).contains(a + b) && (x - y).contains(a - b) && (x * y).contains(a * b));
            prop_assert!((x / y).contains(a / b));
            prop_assert!(x.square().contains(a * a) && x.square().lower() >= 0.0);
            let root = a.max(0.0).sqrt();
            prop_assert!(x.sqrt().contains(root));
            let (sine, cosine) = x.sin_cos();
            // libm is within a unit in the last place.
            let near = |interval: Interval, value: f64| interval.contains(value.next_up()) || interval.contains(value.next_down()) || interval.contains(value);
            prop_assert!(near(sine, libm::sin(a)) && near(cosine, libm::cos(a)));
        }

        #[test]
        fn exact_results_lie_strictly_within(a in -1e3..1e3_f64, b in -1e3..1e3_f64) {
            // The rounding loss is inside too, as the exact remainder's sign shows.
            let sum = Interval::point(a) + Interval::point(b);
            let lost = lost_in_sum(a, b);
            prop_assert!(sum.lower() < a + b && a + b < sum.upper());
            prop_assert!(lost.abs() <= (sum.upper() - (a + b)).min((a + b) - sum.lower()));
        }

        #[test]
        fn sines_of_points_are_thin(x in -9e4..9e4_f64) {
            let (sine, cosine) = Interval::point(x).sin_cos();
            prop_assert!(sine.upper() - sine.lower() < 3e-15 && cosine.upper() - cosine.lower() < 3e-15);
            // sin² + cos² = 1, independent of the library.
            prop_assert!((sine.square() + cosine.square()).contains(1.0));
        }

        #[test]
        fn sine_of_a_sum(a in -50.0..50.0_f64, b in -50.0..50.0_f64) {
            let (sin_a, cos_a) = Interval::point(a).sin_cos();
            let (sin_b, cos_b) = Interval::point(b).sin_cos();
            let (direct, _) = (Interval::point(a) + Interval::point(b)).sin_cos();
            let composed = sin_a * cos_b + cos_a * sin_b;
            prop_assert!(direct.lower() <= composed.upper() && composed.lower() <= direct.upper());
        }
    }

    #[test]
    fn no_end_is_a_subnormal_number() {
        let (zero, least) = (Interval::point(0.0), Interval::point(f64::from_bits(1)));
        let products = [zero * zero, zero * Interval::new(-3.0, 1e-200), least * least, -least * Interval::point(1e-9)];
        for interval in
            products.into_iter().chain([zero + zero, least - Interval::point(1e-160), (zero * zero).square()])
        {
            for end in [interval.lower(), interval.upper()] {
                assert!(end == 0.0 || end.abs() >= TINY, "{interval:?}");
                assert!((end * end).is_normal() || end == 0.0, "{interval:?}");
            }
        }
        // Signs of products that are not rounded to zero are known.
        assert_eq!((Interval::point(-1e-200) * Interval::point(1e-9)).upper(), 0.0);
        assert_eq!((Interval::point(1e-200) * Interval::point(1e-9)).lower(), 0.0);
        assert!((zero * zero).contains(1e-320) && (zero * zero).contains(-1e-320));
    }

    #[test]
    fn unbounded_results_are_the_entire_line() {
        let around_zero = Interval::new(-1.0, 2.0);
        assert_eq!(Interval::point(1.0) / around_zero, Interval::ENTIRE);
        assert_eq!(around_zero.sqrt(), Interval::ENTIRE);
        assert_eq!(Interval::point(f64::NAN), Interval::ENTIRE);
        assert_eq!(Interval::ENTIRE - Interval::ENTIRE, Interval::ENTIRE);
        assert_eq!(Interval::ENTIRE * Interval::point(0.0), Interval::ENTIRE);
        assert_eq!(Interval::ENTIRE.sin_cos().0, Interval::new(-1.0, 1.0));
    }

    #[test]
    fn multiples_of_the_right_angle() {
        // sin(355) = -3.0144353359488449214...e-5, to 18 digits; cos of the f64 nearest to π/2 is
        // 6.123233995736766e-17.
        let (sine, _) = Interval::point(355.0).sin_cos();
        assert!(sine.contains(-3.014_435_335_948_845e-5) && sine.upper() - sine.lower() < 1e-15);
        let (_, cosine) = Interval::point(std::f64::consts::FRAC_PI_2).sin_cos();
        assert!(cosine.contains(6.123_233_995_736_766e-17) && cosine.upper() - cosine.lower() < 1e-15);
    }
}
