//! Antiderivatives: their derivatives are what they are of, and they are zero at zero.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

use symdiff::{Builder, Formula, Scalar};

fn integral(text: &str) -> Option<[f64; 2]> {
    let builder = Builder::new();
    let t = builder.variable("t");
    let of = Formula::parse(text).unwrap().build(&builder, |name| Ok::<_, ()>(builder.variable(name))).unwrap();
    let integral = of.integral(t)?;
    let [slope, integral, of, t] = [integral.derivative(t), integral, of, t].map(Scalar::expr);
    let g = builder.graph();
    let mut worst = [0.0_f64; 2];
    for step in 0..50 {
        let at = 0.0371 * f64::from(step) - 0.4;
        let value_of = |symbol, at: f64| if symbol == t { at } else { 0.7 };
        let values = g.evaluate(&[slope, of], |symbol| value_of(symbol, at));
        worst[0] = worst[0].max((values[0] - values[1]).abs());
        worst[1] = worst[1].max(g.evaluate(&[integral], |symbol| value_of(symbol, 0.0))[0].abs());
    }
    Some(worst)
}

#[test]
fn antiderivatives_are_right() {
    for text in [
        "3",
        "a",
        "t",
        "2*t^3 - a*t + 1",
        "(1 + a*t)^4*(2 - t)",
        "a*(1 + sin(3*t + a))/2",
        "-cos(t/a) - exp(-2*t)",
        "t*sin(3*t)",
        "(t^2 + a)*exp(-a*t) - t^3*cos(2*t)",
        "sqrt(2 + t)",
        "(2 + a*t)^1.5",
        "min(t/a, 1)",
        "5*max(0, 2*(t - 0.3)) - 4*min(a, 1 - t)",
        "max(a, 0.5) + t",
    ] {
        let [slope, start] = integral(text).unwrap_or_else(|| panic!("no integral of {text}"));
        assert!(slope < 1e-12 && start == 0.0, "{text}: {slope:e}, {start:e}");
    }
}

#[test]
fn what_has_no_integral_here_is_told() {
    for text in
        ["sin(t^2)", "sin(t)^2", "sin(t)*cos(2*t)", "1/t", "1/(2 + t)^2", "tanh(t)", "max(sin(t), 0)", "t*sqrt(t + 1)"]
    {
        assert_eq!(integral(text), None, "{text}");
    }
}
