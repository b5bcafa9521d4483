//! Functions of [`DoubleDouble`]s: series on short intervals, and a step of Newton's method from the `f64` for
//! inverses.

use super::DoubleDouble;
use crate::expr::{Binary, Spline, Unary};
use crate::tuning::TUNING;

/// π/2 in two parts, and the rest of it.
const HALF_PI: DoubleDouble = DoubleDouble { high: std::f64::consts::FRAC_PI_2, low: 6.123_233_995_736_766e-17 };
const HALF_PI_REST: f64 = -1.497_384_904_859_169_8e-33;

/// The natural logarithm of two.
const LN_2: DoubleDouble = DoubleDouble { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// Halvings of an exponent before its series, and terms of the series.
const HALVINGS: i32 = 9;
const TERMS_OF_EXP: u32 = 10;

/// Highest power in the series of sine and cosine, up to π/4.
const TERMS_OF_WAVES: u32 = 30;

/// `function(a)`.
pub fn unary(function: Unary, a: DoubleDouble) -> DoubleDouble {
    match function {
        Unary::Neg => -a,
        Unary::Sin => sin_cos(a).0,
        Unary::Cos => sin_cos(a).1,
        Unary::Tan => {
            let (sine, cosine) = sin_cos(a);
            sine / cosine
        }
        Unary::Asin => atan2(a, beside(a)),
        Unary::Acos => atan2(beside(a), a),
        Unary::Atan => atan2(a, DoubleDouble::ONE),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => exp(a),
        Unary::Log => ln(a),
        Unary::Abs => a.abs(),
        Unary::Tanh => tanh(a),
        Unary::Sign => crate::eval::functions::sign(a.high).into(),
        Unary::Floor => a.floor(),
        Unary::Spline(spline, order) => of_spline(spline, order, a),
    }
}

/// `function(a, b)`.
pub fn binary(function: Binary, a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    match function {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => power(a, b),
        Binary::Atan2 => atan2(a, b),
        Binary::Min if (a - b).high < 0.0 || a.high.is_nan() => a,
        Binary::Max if (a - b).high > 0.0 || a.high.is_nan() => a,
        Binary::Min | Binary::Max => b,
        Binary::Select if a.high <= 0.0 => 0.0.into(),
        Binary::SelectElse if a.high <= 0.0 => b,
        Binary::Select => b,
        Binary::SelectElse => 0.0.into(),
    }
}

/// sin a and cos a.
pub fn sin_cos(a: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    if !a.high.is_finite() {
        return (f64::NAN.into(), f64::NAN.into());
    }
    let turns = (a.high / HALF_PI.high).round();
    let r = a - HALF_PI * turns.into() - (HALF_PI_REST * turns).into();
    let (mut sine, mut cosine) = (r, DoubleDouble::ONE);
    let mut term = r;
    for power in 2..=TERMS_OF_WAVES {
        term = term * r / f64::from(power).into();
        let signed = if power % 4 < 2 { term } else { -term };
        if power % 2 == 0 {
            cosine = cosine + signed;
        } else {
            sine = sine + signed;
        }
    }
    match turns.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// √(1 − a²)
fn beside(a: DoubleDouble) -> DoubleDouble {
    ((DoubleDouble::ONE - a) * (DoubleDouble::ONE + a)).sqrt()
}

/// The `f64`'s angle, turned by the small rest.
fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let angle = libm::atan2(y.high, x.high);
    let (sine, cosine) = sin_cos(angle.into());
    let rest = ((y * cosine - x * sine) / (x * cosine + y * sine)).high;
    if rest.is_finite() { DoubleDouble::from(angle) + rest.into() } else { angle.into() }
}

/// eᵃ − 1 for |a| ≤ ½ ln 2.
fn exp_m1_near_zero(a: DoubleDouble) -> DoubleDouble {
    let r = a.scaled(0.5_f64.powi(HALVINGS));
    let (mut value, mut term) = (r, r);
    for power in 2..=TERMS_OF_EXP {
        term = term * r / f64::from(power).into();
        value = value + term;
    }
    for _ in 0..HALVINGS {
        value = value.scaled(2.0) + value * value;
    }
    value
}

/// eᵃ − 1
fn exp_m1(a: DoubleDouble) -> DoubleDouble {
    let twos = (a.high / LN_2.high).round();
    if twos == 0.0 { exp_m1_near_zero(a) } else { exp(a) - DoubleDouble::ONE }
}

fn exp(a: DoubleDouble) -> DoubleDouble {
    let value = libm::exp(a.high);
    if value == 0.0 || !value.is_finite() {
        return value.into();
    }
    let twos = (a.high / LN_2.high).round();
    let rest = exp_m1_near_zero(a - LN_2 * twos.into()) + DoubleDouble::ONE;
    // In two steps: a power of two with an exponent near the limits would over- or underflow.
    let half = (0.5 * twos).trunc();
    rest.scaled(libm::exp2(half)).scaled(libm::exp2(twos - half))
}

fn ln(a: DoubleDouble) -> DoubleDouble {
    let value = libm::log(a.high);
    if !value.is_finite() {
        return value.into();
    }
    DoubleDouble::from(value) + (a * exp((-value).into()) - DoubleDouble::ONE)
}

fn tanh(a: DoubleDouble) -> DoubleDouble {
    let change = exp_m1(-a.abs().scaled(2.0));
    let size = -change / (change + 2.0.into());
    if a.high < 0.0 { -size } else { size }
}

fn power(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    let is_whole = b.low == 0.0 && b.high.fract() == 0.0 && b.high.abs() <= TUNING.factors_of_double_double;
    if is_whole {
        let (mut value, mut square, mut rest) = (DoubleDouble::ONE, a, b.high.abs() as u32);
        while rest > 0 {
            if rest % 2 == 1 {
                value = value * square;
            }
            square = square * square;
            rest /= 2;
        }
        return if b.high < 0.0 { DoubleDouble::ONE / value } else { value };
    }
    if a.high > 0.0 { exp(b * ln(a)) } else { libm::pow(a.high, b.high).into() }
}

/// The derivative of a table, of this order, on the piece of the `f64`.
fn of_spline(spline: Spline, order: u8, x: DoubleDouble) -> DoubleDouble {
    let (from, cubic) = spline.cubic_at(x.high);
    let s = x - from.into();
    let [a, b, c, d] = cubic.map(DoubleDouble::from);
    let [three, six] = [3.0, 6.0].map(DoubleDouble::from);
    match order {
        0 => a + s * (b + s * (c + s * d)),
        1 => b + s * (c.scaled(2.0) + three * s * d),
        2 => c.scaled(2.0) + six * s * d,
        3 => six * d,
        _ => 0.0.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::apart;
    use super::*;

    fn number(a: f64) -> DoubleDouble {
        DoubleDouble::from(a) / 7.0.into()
    }

    /// Digits by mpmath, as the difference from the `f64`: the constants of the series, and values of functions.
    #[test]
    fn values_match_mpmath_with_forty_digits() {
        let at = |function: Unary, a: f64| unary(function, a.into());
        for (found, high, low) in [
            (at(Unary::Exp, 1.0), std::f64::consts::E, 1.445_646_891_729_250_2e-16),
            (at(Unary::Log, 10.0), std::f64::consts::LN_10, -2.170_756_223_382_249_4e-16),
            (at(Unary::Atan, 1.0), std::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17),
            (at(Unary::Sqrt, 2.0), std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17),
            (at(Unary::Acos, 0.5), std::f64::consts::FRAC_PI_3, -1.072_081_766_451_091e-16),
        ] {
            assert!(apart(found, DoubleDouble { high, low }) < 1e-31, "{found:?} {high} {low}");
        }
    }

    /// Identities between functions, at numbers of both signs and several sizes.
    #[test]
    fn identities_hold_to_thirty_digits() {
        for a in [0.3, -0.02, 2.5, -5.0, 17.0, 300.0].map(number) {
            let (sine, cosine) = sin_cos(a);
            assert!(apart(sine * sine + cosine * cosine, DoubleDouble::ONE) < 1e-30);
            let (double, _) = sin_cos(a.scaled(2.0));
            assert!(apart((sine * cosine).scaled(2.0), double) < 1e-29, "{a:?}");
            assert!(apart(unary(Unary::Log, unary(Unary::Exp, a)), a) < 1e-29, "{a:?}");
            let angle = unary(Unary::Atan, a);
            assert!(apart(unary(Unary::Tan, angle), a) < 1e-29, "{a:?}");
            let exponential = unary(Unary::Exp, a.scaled(2.0));
            let tanh = (exponential - DoubleDouble::ONE) / (exponential + DoubleDouble::ONE);
            assert!(apart(unary(Unary::Tanh, a), tanh) < 1e-28, "{a:?}");
            let cubed = binary(Binary::Pow, a, 3.0.into());
            assert!(apart(cubed, a * a * a) < 1e-30);
            let root = binary(Binary::Pow, a.abs(), DoubleDouble::ONE / 3.0.into());
            assert!(apart(root * root * root, a.abs()) < 1e-29);
        }
        for a in [0.3, -2.0, 6.9].map(number) {
            let angle = unary(Unary::Asin, a);
            assert!(apart(sin_cos(angle).0, a) < 1e-29, "{a:?}");
            assert!(apart(angle + unary(Unary::Acos, a), HALF_PI) < 1e-30);
        }
    }

    /// Every function agrees with that of `f64` to its digits.
    #[test]
    fn functions_match_those_of_f64_tapes() {
        let table = Spline::through(&[(-9.0, 1.0), (-1.0, -3.0), (0.5, 2.0), (3.0, 2.5), (8.0, 0.0)]).unwrap();
        let wave = Spline::periodic(&[(0.0, 1.0), (0.5, 2.0), (1.5, 1.0)]).unwrap();
        let mut functions = vec![Unary::Neg, Unary::Sin, Unary::Cos, Unary::Tan, Unary::Asin, Unary::Acos, Unary::Atan];
        functions.extend([Unary::Sqrt, Unary::Exp, Unary::Log, Unary::Abs, Unary::Tanh, Unary::Sign, Unary::Floor]);
        functions.extend((0..5).flat_map(|order| [Unary::Spline(table, order), Unary::Spline(wave, order)]));
        let near = |found: f64, expected: f64, what: &dyn std::fmt::Debug| {
            let is_same = found == expected || (found.is_nan() && expected.is_nan());
            assert!(
                is_same || (found - expected).abs() <= 1e-13 * (1.0 + expected.abs()),
                "{what:?} {found} {expected}"
            );
        };
        let numbers = [-710.0, -7.3, -1.0, -0.2, 0.0, 0.7, 1.0, 2.5, 9.1, 700.0];
        for a in numbers {
            for &function in &functions {
                let expected = crate::eval::functions::unary(function, a);
                near(unary(function, a.into()).to_f64(), expected, &(function, a));
            }
            for b in numbers {
                for function in [
                    Binary::Add,
                    Binary::Sub,
                    Binary::Mul,
                    Binary::Div,
                    Binary::Pow,
                    Binary::Atan2,
                    Binary::Min,
                    Binary::Max,
                    Binary::Select,
                    Binary::SelectElse,
                ] {
                    let expected = crate::eval::functions::binary(function, a, b);
                    near(binary(function, a.into(), b.into()).to_f64(), expected, &(function, a, b));
                }
            }
        }
    }
}
