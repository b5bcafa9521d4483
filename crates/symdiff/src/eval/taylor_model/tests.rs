//! Enclosures of functions, against their values at points.

use super::*;
use crate::eval::functions;
use crate::expr::{Binary, Spline};
use proptest::prelude::*;

/// Σ aᵣ ξ^r.
fn value(space: &ModelSpace, a: &[f64], xi: &[f64]) -> f64 {
    let monomials = space.jets().monomials();
    (0..monomials.len())
        .map(|r| a[r] * xi.iter().zip(monomials.exponents(r)).map(|(x, &p)| x.powi(p as i32)).product::<f64>())
        .sum()
}

proptest! {
    #[test]
    fn models_enclose_functions_of_their_members(
        order in 1..8_usize,
        (a, b) in (prop::array::uniform3(-0.6..0.6_f64), prop::array::uniform3(-0.6..0.6_f64)),
        (e, f) in (prop_oneof![Just(0.0), 0.0..0.1_f64], prop_oneof![Just(0.0), 0.0..0.1_f64]),
        xi in prop::array::uniform2(-1.0..=1.0_f64),
        (at, bt) in (-1.0..=1.0_f64, -1.0..=1.0_f64),
    ) {
        let space = ModelSpace::new(2, order);
        let mut scratch = ModelScratch::new(&space);
        let model = |c: &[f64; 3], offset: f64, e: f64| {
            let mut model = vec![0.0; space.size()];
            model[..3].copy_from_slice(c);
            model[0] += offset;
            model[space.size() - 1] = e;
            model
        };
        let (a, b) = (model(&a, 0.0, e), model(&b, 2.0, f));
        // Members of the models at ξ.
        let (x, y) = (value(&space, &a, &xi) + at * e, value(&space, &b, &xi) + bt * f);
        let mut out = vec![0.0; space.size()];
        let mut second = out.clone();
        let inside = |out: &[f64], exact: f64| {
            let radius = out[space.size() - 1];
            // The test's own rounding.
            let close = (value(&space, out, &xi) - exact).abs() <= radius + 1e-14 * (1.0 + exact.abs());
            prop_assert!(close, "{exact} is not within {radius:e} of {}", value(&space, out, &xi));
            Ok(())
        };
        space.add(&a, &b, &mut out);
        inside(&out, x + y)?;
        space.sub(&a, &b, &mut out);
        inside(&out, x - y)?;
        space.mul(&a, &b, &mut out);
        inside(&out, x * y)?;
        space.div(&a, &b, &mut out, &mut scratch);
        inside(&out, x / y)?;
        space.unary(Unary::Sqrt, &b, &mut out, &mut scratch);
        inside(&out, y.sqrt())?;
        space.sin_cos(&b, &mut out, &mut second, &mut scratch);
        inside(&out, y.sin())?;
        inside(&second, y.cos())?;
        space.scale(Interval::new(-0.3, -0.1), &a, &mut out);
        inside(&out, -0.2 * x)?;
        for function in [Unary::Exp, Unary::Atan, Unary::Tanh, Unary::Tan] {
            space.unary(function, &a, &mut out, &mut scratch);
            inside(&out, functions::unary(function, x))?;
        }
        space.unary(Unary::Log, &b, &mut out, &mut scratch);
        inside(&out, y.ln())?;
        let mut shrunk = a.clone();
        space.scale(Interval::point(0.4), &a, &mut shrunk);
        for function in [Unary::Asin, Unary::Acos] {
            space.unary(function, &shrunk, &mut out, &mut scratch);
            inside(&out, functions::unary(function, 0.4 * x))?;
        }
        let mut exponent = vec![0.0; space.size()];
        for power in [3.0, -2.0, 0.0, 1.5, -0.7] {
            exponent[0] = power;
            space.binary(Binary::Pow, &b, &exponent, &mut out, &mut scratch);
            inside(&out, y.powf(power))?;
        }
        space.binary(Binary::Pow, &b, &a, &mut out, &mut scratch);
        inside(&out, y.powf(x))?;
        for (from, to) in [(&a, &b), (&b, &a)] {
            let [x, y] = if std::ptr::eq(from, &a) { [x, y] } else { [y, x] };
            space.binary(Binary::Atan2, from, to, &mut out, &mut scratch);
            inside(&out, x.atan2(y))?;
        }
        for function in [Binary::Min, Binary::Max] {
            space.binary(function, &a, &b, &mut out, &mut scratch);
            inside(&out, functions::binary(function, x, y))?;
        }
        let points = [(-1.5, 1.0), (-0.4, -3.0), (0.5, 2.0), (1.9, 2.5), (2.2, 1.7), (3.0, 1.0)];
        for spline in [Spline::through(&points), Spline::periodic(&points), Spline::linear(&points)].map(Result::unwrap) {
            for (order, (model, at)) in (0..4).flat_map(|order| [(order, (&a, x)), (order, (&b, y))]) {
                space.unary(Unary::Spline(spline, order), model, &mut out, &mut scratch);
                inside(&out, spline.derivative(order, at))?;
            }
        }
    }
}

#[test]
fn radii_of_every_smooth_function_fall_with_the_order() {
    let functions = [Unary::Exp, Unary::Log, Unary::Atan, Unary::Tanh, Unary::Asin, Unary::Acos, Unary::Tan];
    for function in functions {
        let radius = |order: usize| {
            let space = ModelSpace::new(2, order);
            let mut scratch = ModelScratch::new(&space);
            let (mut a, mut out) = (vec![0.0; space.size()], vec![0.0; space.size()]);
            space.variable(0, 0.45, 0.55, &mut a);
            a[2] = 0.03;
            space.unary(function, &a, &mut out, &mut scratch);
            out[space.size() - 1]
        };
        for order in 1..8 {
            let (this, next) = (radius(order), radius(order + 1));
            assert!(next < 0.5 * this + 1e-14, "{function:?} {order}: {this:e}, then {next:e}");
        }
        assert!(radius(20) < 1e-14, "{function:?}: {:e}", radius(20));
    }
}

#[test]
fn radius_at_a_knot_grows_with_the_third_power() {
    let spline = Spline::through(&[(0.0, 1.0), (1.0, -2.0), (2.0, 0.3), (3.0, 5.0)]).unwrap();
    let radius = |beyond: f64| {
        let space = ModelSpace::new(1, 4);
        let mut scratch = ModelScratch::new(&space);
        let (mut a, mut out) = (vec![0.0; space.size()], vec![0.0; space.size()]);
        space.variable(0, 1.0 - 2.0 * beyond, 1.0 + beyond, &mut a);
        space.unary(Unary::Spline(spline, 0), &a, &mut out, &mut scratch);
        out[space.size() - 1]
    };
    for beyond in [1e-1, 1e-2] {
        let ratio = radius(beyond) / radius(0.1 * beyond);
        assert!((ratio - 1000.0).abs() < 5.0, "{beyond}: {ratio}");
    }
}

#[test]
fn radii_fall_with_the_order() {
    let radius = |order: usize| {
        let space = ModelSpace::new(1, order);
        let mut scratch = ModelScratch::new(&space);
        let (mut a, mut out, mut second) = (vec![0.0; space.size()], vec![0.0; space.size()], vec![0.0; space.size()]);
        space.variable(0, 0.9, 1.1, &mut a);
        space.sin_cos(&a, &mut out, &mut second, &mut scratch);
        second.copy_from_slice(&out);
        space.div(&second, &a, &mut out, &mut scratch);
        out[space.size() - 1]
    };
    // sin x / x is an entire function: its Taylor series falls faster than any power.
    for order in 1..10 {
        let (this, next) = (radius(order), radius(order + 1));
        assert!(next < 0.2 * this + 5e-15, "{order}: {this:e}, then {next:e}");
    }
    assert!(radius(12) < 5e-15, "{:e}", radius(12));
}

#[test]
fn unbounded_functions_have_infinite_radius() {
    let space = ModelSpace::new(1, 3);
    let mut scratch = ModelScratch::new(&space);
    let (mut a, mut out) = (vec![0.0; space.size()], vec![0.0; space.size()]);
    space.variable(0, -0.1, 1.0, &mut a);
    let one = [1.0, 0.0, 0.0, 0.0, 0.0];
    space.div(&one, &a, &mut out, &mut scratch);
    assert_eq!(out[4], f64::INFINITY);
    for function in [Unary::Sqrt, Unary::Sign, Unary::Log] {
        space.unary(function, &a, &mut out, &mut scratch);
        assert_eq!(out[4], f64::INFINITY, "{function:?}");
    }
    // A kink has a radius: the excess of the other side.
    space.unary(Unary::Abs, &a, &mut out, &mut scratch);
    assert!((out[4] - 0.2).abs() < 1e-9, "{}", out[4]);
    let ranges = ModelSpace::new(1, 3).with_ranges_of_signs();
    ranges.unary(Unary::Sign, &a, &mut out, &mut scratch);
    assert!(out[0].abs() < 1e-300 && (out[4] - 1.0).abs() < 1e-12, "{out:?}");
}

/// Integers are exact rationals: sums and products of whole numbers of 52 bits, in 128 bits.
mod exactly {
    use proptest::prelude::*;

    use crate::eval::interval::Interval;
    use crate::eval::taylor_model::ModelSpace;

    const SMALL: i64 = 1 << 52;

    /// 1, x, y, x², xy, y² at x = i/2, y = j/2, times 4.
    fn powers(i: i128, j: i128) -> [i128; 6] {
        [4, 2 * i, 2 * j, i * i, i * j, j * j]
    }

    /// The polynomial with integer coefficients at that point, times 4.
    fn at(coefficients: impl Iterator<Item = i128>, [i, j]: [i128; 2]) -> i128 {
        coefficients.zip(powers(i, j)).map(|(c, power)| c * power).sum()
    }

    fn coefficients() -> impl Strategy<Value = [i64; 6]> {
        proptest::array::uniform6(-SMALL..SMALL)
    }

    fn inside() -> impl Strategy<Value = [i128; 2]> {
        proptest::array::uniform2(-2..=2_i128)
    }

    proptest! {
        #[test]
        fn models_enclose_sums_and_products(a in coefficients(), b in coefficients(), point in inside()) {
            let space = ModelSpace::new(2, 2);
            let model = |of: [i64; 6]| -> Vec<f64> { of.iter().map(|&c| c as f64).chain([0.0]).collect() };
            let exact = |of: [i64; 6]| at(of.into_iter().map(i128::from), point);
            let mut out = vec![0.0; space.size()];
            let is_enclosed = |out: &[f64], sixteenfold: i128| {
                // Coefficients are whole numbers below 2^108, and the radius is rounded up.
                let found = 4 * at(out[..6].iter().map(|&c| c as i128), point);
                (found - sixteenfold).abs() <= (16.0 * out[6]).ceil() as i128
            };
            space.add(&model(a), &model(b), &mut out);
            prop_assert!(is_enclosed(&out, 4 * (exact(a) + exact(b))));
            space.sub(&model(a), &model(b), &mut out);
            prop_assert!(is_enclosed(&out, 4 * (exact(a) - exact(b))));
            space.mul(&model(a), &model(b), &mut out);
            prop_assert!(is_enclosed(&out, exact(a) * exact(b)));
        }

        #[test]
        fn intervals_enclose_sums_and_products(a in -SMALL..SMALL, b in -SMALL..SMALL, c in -SMALL..SMALL) {
            let point = |value: i64| Interval::point(value as f64);
            let found = point(a) * point(b) + point(c);
            let exact = i128::from(a) * i128::from(b) + i128::from(c);
            prop_assert!(found.lower().ceil() as i128 <= exact && exact <= found.upper().floor() as i128);
        }
    }
}
