//! Numbers of twice the digits: the unevaluated sum of two `f64`, with about 32 decimal digits.
//!
//! Sums and products are those of Dekker, *A floating-point technique for extending the available precision*, Numer.
//! Math. 18 (1971) 224, without fused operations: errors of a few units of 2⁻¹⁰⁴. Differences of functions computed in
//! this way give derivatives with more digits than an `f64` has.

mod functions;
mod memory;

use std::ops::{Add, Div, Mul, Neg, Sub};

pub use memory::DoubleDoubleMemory;

/// high + low, where low is at most half a unit in the last place of high.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// 2²⁷ + 1: splits a number into halves whose products are exact.
const SPLITTER: f64 = 134_217_729.0;

/// a + b and its rounding error.
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let of_b = high - a;
    DoubleDouble { high, low: (a - (high - of_b)) + (b - of_b) }.finite()
}

/// The same if |a| is no less than |b|.
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }.finite()
}

fn halves(a: f64) -> [f64; 2] {
    let large = SPLITTER * a;
    let high = large - (large - a);
    [high, a - high]
}

/// a b and its rounding error.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ([a1, a2], [b1, b2]) = (halves(a), halves(b));
    DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }.finite()
}

impl DoubleDouble {
    /// 1
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.high
    }

    /// The same, without a rounding error if the sum is not finite.
    fn finite(self) -> Self {
        if self.low.is_finite() { self } else { self.high.into() }
    }

    /// |a|
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// √a, by a step of Newton's method from the `f64`.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        if root == 0.0 || !root.is_finite() {
            return root.into();
        }
        ordered_sum(root, (self - product(root, root)).high / (2.0 * root))
    }

    /// The largest integer that is not larger.
    #[must_use]
    pub fn floor(self) -> Self {
        let high = self.high.floor();
        if high == self.high { ordered_sum(high, self.low.floor()) } else { high.into() }
    }

    /// Its product with a power of two, exactly.
    fn scaled(self, factor: f64) -> Self {
        Self { high: self.high * factor, low: self.low * factor }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let first = ordered_sum(high.high, high.low + low.high);
        ordered_sum(first.high, first.low + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let exact = product(self.high, other.high);
        if !exact.high.is_finite() {
            return exact;
        }
        ordered_sum(exact.high, exact.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        if first == 0.0 || !first.is_finite() {
            return first.into();
        }
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let third = (rest - other * second.into()).high / other.high;
        let quotient = ordered_sum(first, second);
        quotient + third.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The difference of two numbers, as a share of the second.
    pub(super) fn apart(a: DoubleDouble, b: DoubleDouble) -> f64 {
        ((a - b) / b).to_f64().abs()
    }

    #[test]
    fn sums_products_quotients_and_roots_have_thirty_digits() {
        let third = DoubleDouble::ONE / 3.0.into();
        assert!(apart(third * 3.0.into(), DoubleDouble::ONE) < 1e-31);
        let small = DoubleDouble::from(1e-20);
        assert_eq!(((DoubleDouble::ONE + small) - DoubleDouble::ONE).to_f64(), 1e-20);
        let root = DoubleDouble::from(2.0).sqrt();
        assert!(apart(root * root, 2.0.into()) < 1e-31);
        let (a, b) = (DoubleDouble::from(0.1) / 7.0.into(), DoubleDouble::from(1e5) / 11.0.into());
        assert!(apart((a + b) * (a - b), a * a - b * b) < 1e-30);
        assert_eq!((DoubleDouble::from(3.0) - small).floor().to_f64(), 2.0);
        assert_eq!((DoubleDouble::from(3.0) + small).floor().to_f64(), 3.0);
    }

    #[test]
    fn infinities_and_nan_are_kept() {
        assert_eq!((DoubleDouble::ONE / 0.0.into()).to_f64(), f64::INFINITY);
        assert!(DoubleDouble::from(-1.0).sqrt().to_f64().is_nan());
        assert_eq!((DoubleDouble::from(1e300) * 1e300.into()).to_f64(), f64::INFINITY);
    }
}
