//! Functions of one `f64`: the single definition that folding, direct evaluation and tapes share.

use crate::eval::sincos::sin_cos;
use crate::expr::{Binary, Unary};

/// `function(a)`. Transcendental functions are `libm`'s, so that every platform gives the same bits.
#[inline(always)]
pub fn unary(function: Unary, a: f64) -> f64 {
    match function {
        Unary::Neg => -a,
        Unary::Sin => sin_cos(a).0,
        Unary::Cos => sin_cos(a).1,
        Unary::Tan => libm::tan(a),
        Unary::Asin => libm::asin(a),
        Unary::Acos => libm::acos(a),
        Unary::Atan => libm::atan(a),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => libm::exp(a),
        Unary::Log => libm::log(a),
        Unary::Abs => a.abs(),
        Unary::Tanh => libm::tanh(a),
        Unary::Sign => sign(a),
        Unary::Floor => a.floor(),
        Unary::Spline(spline, order) => spline.derivative(order, a),
    }
}

/// `function(a, b)`.
#[inline(always)]
pub fn binary(function: Binary, a: f64, b: f64) -> f64 {
    match function {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => libm::pow(a, b),
        Binary::Atan2 => libm::atan2(a, b),
        Binary::Min => min(a, b),
        Binary::Max => max(a, b),
        Binary::Select => select(a, b, 0.0),
        Binary::SelectElse => select(a, 0.0, b),
    }
}

/// b if a is positive or NaN, otherwise c.
#[inline(always)]
pub fn select(a: f64, b: f64, c: f64) -> f64 {
    if a <= 0.0 { c } else { b }
}

/// −1, 0 or 1; unlike `f64::signum`, zero at zero. NaN for NaN.
#[inline(always)]
pub fn sign(a: f64) -> f64 {
    if a > 0.0 {
        1.0
    } else if a < 0.0 {
        -1.0
    } else {
        a
    }
}

/// The smaller; NaN if either is NaN (`f64::min` would hide it).
#[inline(always)]
pub fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The larger; NaN if either is NaN.
#[inline(always)]
pub fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
