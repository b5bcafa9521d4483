//! Functions of [`Interval`]s. Functions of `libm` are within a unit in the last place, as measured, and are assumed to
//! be within four.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::interval::{Interval, TINY};
use crate::expr::{Binary, Unary};
use crate::tuning::TUNING;

/// Encloses `function(a)` for every member of a; all numbers if it is undefined for a member.
pub fn unary(function: Unary, a: Interval) -> Interval {
    match function {
        Unary::Neg => -a,
        Unary::Sin => wave(a, FRAC_PI_2, libm::sin),
        Unary::Cos => wave(a, 0.0, libm::cos),
        Unary::Tan if ((a.lower() + FRAC_PI_2) / PI).floor() == ((a.upper() + FRAC_PI_2) / PI).floor() => {
            rising(a, libm::tan)
        }
        Unary::Asin if a.magnitude() <= 1.0 => rising(a, libm::asin),
        Unary::Acos if a.magnitude() <= 1.0 => -rising(-a, |x| -libm::acos(-x)),
        Unary::Tan | Unary::Asin | Unary::Acos => Interval::ENTIRE,
        Unary::Atan => rising(a, libm::atan),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => {
            let value = rising(a, libm::exp);
            Interval::new(value.lower().max(0.0), value.upper())
        }
        Unary::Log if a.lower() > 0.0 => rising(a, libm::log),
        Unary::Log => Interval::ENTIRE,
        Unary::Abs => magnitude(a),
        Unary::Tanh => rising(a, libm::tanh),
        Unary::Sign => Interval::new(sign(a.lower()), sign(a.upper())),
        Unary::Floor => Interval::new(a.lower().floor(), a.upper().floor()),
        Unary::Spline(spline, order) => spline.enclose(order, a),
    }
}

/// Encloses `function(a, b)` for every pair of members.
pub fn binary(function: Binary, a: Interval, b: Interval) -> Interval {
    match function {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => power(a, b),
        Binary::Atan2 if b.lower() > 0.0 => unary(Unary::Atan, a / b),
        Binary::Atan2 => widened(-PI, PI),
        Binary::Min => Interval::new(a.lower().min(b.lower()), a.upper().min(b.upper())),
        Binary::Max => Interval::new(a.lower().max(b.lower()), a.upper().max(b.upper())),
        Binary::Select if a.lower() > 0.0 => b,
        Binary::SelectElse if a.upper() <= 0.0 => b,
        Binary::Select if a.upper() <= 0.0 => Interval::point(0.0),
        Binary::SelectElse if a.lower() > 0.0 => Interval::point(0.0),
        Binary::Select | Binary::SelectElse => Interval::new(b.lower().min(0.0), b.upper().max(0.0)),
    }
}

fn sign(a: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a.signum() }
}

/// Computed ends with an allowance for the library's error.
fn widened(lower: f64, upper: f64) -> Interval {
    let allowance = |value: f64| TUNING.of_library * value.abs() + TINY;
    Interval::new(lower - allowance(lower), upper + allowance(upper))
}

fn rising(a: Interval, function: impl Fn(f64) -> f64) -> Interval {
    widened(function(a.lower()), function(a.upper()))
}

pub(crate) fn magnitude(a: Interval) -> Interval {
    let least = if a.contains(0.0) { 0.0 } else { a.lower().abs().min(a.upper().abs()) };
    Interval::new(least, a.magnitude())
}

/// A wave of period 2π between −1 and 1 with a crest at `crest`.
fn wave(a: Interval, crest: f64, function: impl Fn(f64) -> f64) -> Interval {
    let whole = Interval::new(-1.0, 1.0);
    if a.upper() - a.lower() >= TAU {
        return whole;
    }
    // Whether a point crest + n 2π lies in the interval, up to rounding.
    let slack = 1e-9 + 4.0 * f64::EPSILON * a.magnitude();
    let meets = |point: f64| ((a.upper() + slack - point) / TAU).floor() >= ((a.lower() - slack - point) / TAU).ceil();
    let [first, last] = [a.lower(), a.upper()].map(function);
    let lower = if meets(crest + PI) { -1.0 } else { first.min(last) };
    let upper = if meets(crest) { 1.0 } else { first.max(last) };
    let ends = widened(lower, upper);
    Interval::new(ends.lower().max(-1.0), ends.upper().min(1.0))
}

fn power(a: Interval, b: Interval) -> Interval {
    let point = b.lower() == b.upper();
    let exponent = b.lower();
    let of = |lower: f64, upper: f64| widened(libm::pow(lower, exponent), libm::pow(upper, exponent));
    match point {
        true if exponent == 0.0 => Interval::point(1.0),
        true if exponent < 0.0 => Interval::point(1.0) / power(a, -b),
        true if exponent % 2.0 == 0.0 => {
            let size = magnitude(a);
            of(size.lower(), size.upper())
        }
        true if exponent.fract() == 0.0 || a.lower() >= 0.0 => of(a.lower(), a.upper()),
        false if a.lower() > 0.0 => unary(Unary::Exp, b * unary(Unary::Log, a)),
        _ => Interval::ENTIRE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Spline;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn functions_enclose(
            a in -20.0..20.0_f64, width in prop_oneof![Just(0.0), 0.0..1e-6_f64, 0.0..9.0_f64], at in 0.0..=1.0_f64,
            b in -6.0..6.0_f64,
        ) {
            let x = Interval::new(a, a + width);
            let inside = (a + at * width).clamp(x.lower(), x.upper());
            let table = Spline::through(&[(-9.0, 1.0), (-1.0, -3.0), (0.5, 2.0), (3.0, 2.5), (8.0, 0.0)]).unwrap();
            let mut functions = vec![
                Unary::Neg, Unary::Sin, Unary::Cos, Unary::Tan, Unary::Asin, Unary::Acos, Unary::Atan, Unary::Sqrt,
                Unary::Exp, Unary::Log, Unary::Abs, Unary::Tanh, Unary::Sign,
                Unary::Floor,
            ];
            functions.extend((0..5).map(|order| Unary::Spline(table, order)));
            for function in functions {
                let value = crate::eval::functions::unary(function, inside);
                let range = unary(function, x);
                prop_assert!(value.is_nan() || range.contains(value), "{function:?} {range:?} {value}");
            }
            let y = Interval::new(b, b + 0.5 * width);
            for function in [
                Binary::Add, Binary::Sub, Binary::Mul, Binary::Div, Binary::Pow, Binary::Atan2, Binary::Min, Binary::Max,
                Binary::Select, Binary::SelectElse,
            ] {
                for other in [Interval::point(b.round()), y] {
                    let value = crate::eval::functions::binary(function, inside, other.lower());
                    let range = binary(function, x, other);
                    prop_assert!(value.is_nan() || range.contains(value), "{function:?} {range:?} {value}");
                }
            }
        }
    }

    #[test]
    fn ranges_of_waves_are_tight() {
        let tight = |found: Interval, lower: f64, upper: f64| {
            assert!(found.contains(lower) && found.contains(upper));
            assert!(found.lower() > lower - 1e-12 && found.upper() < upper + 1e-12, "{found:?}");
        };
        tight(unary(Unary::Sin, Interval::new(1.0, 2.0)), libm::sin(1.0), 1.0);
        tight(unary(Unary::Sin, Interval::new(1.0, 1.1)), libm::sin(1.0), libm::sin(1.1));
        tight(unary(Unary::Cos, Interval::new(3.0, 7.0)), -1.0, 1.0);
        tight(unary(Unary::Cos, Interval::new(4.0, 6.0)), libm::cos(4.0), libm::cos(6.0));
        tight(unary(Unary::Cos, Interval::new(-0.1, 0.1)), libm::cos(0.1), 1.0);
    }
}
