//! Antiderivatives: their derivatives are the integrands, and they vanish at zero.

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
        "floor(3*t)",
        "2*mod(t, 0.3) - abs(1 - 4*t)/a",
        "if(t < 0.5, 1, 3)",
        "if(t >= a, t^2*a, sin(2*t))",
        "if(t < 0.2, 0, if(t < 0.9, 2*(t - 0.2), 1.4))",
        "a*smoothstep(0.2, 0.8, t)",
        "clamp(3 - 5*t, -1, 0.5)^3 + max(t, a)^2",
    ] {
        let [slope, start] = integral(text).unwrap_or_else(|| panic!("no integral of {text}"));
        assert!(slope < 1e-12 && start == 0.0, "{text}: {slope:e}, {start:e}");
    }
}

/// Derivatives between jumps and corners do not determine the steps between two pieces: integrals by hand.
#[test]
fn integrals_of_pieces_are_their_areas() {
    for (text, end, area) in [
        ("if(t < 0.5, 1, 3)", 2.0, 5.0),
        ("if(t < 0.5, t^2, 1 - t)", 1.0, 1.0 / 24.0 + 0.125),
        ("if(0.5 > t, 1, 3)", 0.25, 0.25),
        ("if(t <= 0.2, 0, if(t < 0.9, 2*(t - 0.2), 1.4))", 1.0, 0.49 + 0.14),
        ("if(t > 0.2 and t < 0.5, 3, 1)", 1.0, 0.9 + 0.7),
        ("if(t > 0.2 and t < 0.5, 3, 1)", 0.3, 0.2 + 0.3),
        ("if(t < 0.2 or t > 0.5, t, 2)", 1.0, 0.02 + 0.6 + 0.375),
        ("if(not (t < 0.2 or t > 0.5) and t < 0.4, 1, 0)", 1.0, 0.2),
        ("if(t >= 0.1 and (t < 0.3 or t > 0.6) and t < 0.7, 1, 0)", 1.0, 0.3),
        ("floor(t)", 2.5, 2.0),
        ("floor(3*t)", 1.0, 1.0),
        ("mod(t, 0.3)", 1.0, 0.14),
        ("abs(t - 0.5)", 1.0, 0.25),
        ("smoothstep(0.2, 0.8, t)", 1.0, 0.5),
        ("t*smoothstep(0.2, 0.8, 0.9)", 2.0, 2.0),
        ("max(t, 0.3)^2", 1.0, 0.027 + (1.0 - 0.027) / 3.0),
        ("clamp(1 - t, 0.25, 0.5)^2", 1.0, 0.5 * 0.25 + (0.125 - 0.015_625) / 3.0 + 0.25 * 0.0625),
    ] {
        let builder = Builder::new();
        let t = builder.variable("t");
        let of = Formula::parse(text).unwrap().build(&builder, |_| Ok::<_, ()>(t)).unwrap();
        let integral = of.integral(t).unwrap_or_else(|| panic!("no integral of {text}"));
        let found = builder.graph().evaluate(&[integral.expr()], |_| end)[0];
        assert!((found - area).abs() < 1e-14, "{text}: {found} instead of {area}");
    }
}

#[test]
fn functions_without_known_integral_are_refused() {
    for text in
        ["sin(t^2)", "sin(t)^2", "sin(t)*cos(2*t)", "1/t", "1/(2 + t)^2", "tanh(t)", "max(sin(t), 0)", "t*sqrt(t + 1)"]
            .into_iter()
            // Their derivatives end like a polynomial's.
            .chain([
                "t*floor(t)",
                "sin(2*t + floor(t))",
                "if(sin(t) > 0, 1, 2)",
                "if((t > 1) + (t > 2), 1, 2)",
                "if(t > 1 and t^2 < 3, 1, 2)",
                "t*max(t, 0.5)",
                "t*abs(t)",
            ])
    {
        assert_eq!(integral(text), None, "{text}");
    }
}
