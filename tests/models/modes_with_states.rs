//! Modes of masses and rotors with states: controllers, motors, filters and delays, against roots of characteristic
//! polynomials, poles of filters and limits of stability.

use mbint::results::{Bounds, Method};

use crate::common::{nominal, ran, read, run, study_of};
use crate::statics::{close, ends, value};

pub(crate) const TAU: f64 = std::f64::consts::TAU;

pub(crate) type Complex = nalgebra::Complex<f64>;

/// All roots of c₀ sⁿ + … + cₙ by Durand and Kerner's iteration, the slowest first.
pub(crate) fn roots(coefficients: &[f64]) -> Vec<Complex> {
    let order = coefficients.len() - 1;
    let value = |s: Complex| coefficients.iter().fold(Complex::new(0.0, 0.0), |sum, c| sum * s + c / coefficients[0]);
    let size = (coefficients[order] / coefficients[0]).abs().powf(1.0 / order as f64);
    let mut found: Vec<Complex> = (0..order).map(|index| Complex::new(0.4, 0.9).powu(index as u32) * size).collect();
    for _ in 0..2000 {
        for index in 0..order {
            let others = (0..order).filter(|&other| other != index).map(|other| found[index] - found[other]);
            let change = value(found[index]) / others.product::<Complex>();
            found[index] -= change;
        }
    }
    found.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    found
}

/// Compares mode by mode with eigenvalues, of which one of each pair stands there, the slowest first.
#[track_caller]
pub(crate) fn are(bounds: &Bounds, wanted: &[Complex], tolerance: f64) {
    for (index, root) in wanted.iter().enumerate() {
        let told = |quantity: &str| value(bounds, &format!("mode{}.{quantity}", index + 1));
        close(told("growth"), root.re, tolerance);
        if root.im == 0.0 {
            close(told("time_constant"), -1.0 / root.re, tolerance);
        } else {
            close(TAU * told("frequency"), root.norm(), tolerance);
            close(told("damping"), -root.re / root.norm(), tolerance);
        }
    }
    close(value(bounds, "growth"), largest_growth(wanted), tolerance);
    assert!(!bounds.outputs.iter().any(|output| output.name == format!("mode{}.growth", wanted.len() + 1)));
}

pub(crate) fn largest_growth(roots: &[Complex]) -> f64 {
    roots.iter().map(|root| root.re).fold(f64::NEG_INFINITY, f64::max)
}

/// One of each pair, those that are real exactly so.
pub(crate) fn one_of_each(roots: Vec<Complex>) -> Vec<Complex> {
    let real = |root: Complex| if root.im.abs() < 1e-9 * root.norm() { Complex::new(root.re, 0.0) } else { root };
    roots.into_iter().map(real).filter(|root| root.im >= 0.0).collect()
}

/// A mass of 2 kg on a spring under u = −20 x − ki ∫x: 2 s³ + 4 s² + 70 s + ki = 0.
fn controlled(ki: &str, more: &str) -> String {
    format!(
        "
analysis: modes
parameters: {{ ki: {ki} }}
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
states: {{ integral: {{ rate: -m.x, initial: 0 m*s }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, m], along: x, stiffness: 50, damping: 4, free_length: 0 }} }}
  pull: {{ force: {{ on: m, value: [ki*(1 N/m/s)*integral - 20 N/m*m.x, 0] }} }}
outputs: {{ x: m.x, integral: integral }}
bounds: {{ chebyshev: {{ order: 8 }}, scan: {{ points: 9 }} }}
{more}
"
    )
}

fn cubic(ki: f64) -> Vec<Complex> {
    one_of_each(roots(&[2.0, 4.0, 70.0, ki]))
}

#[test]
fn roots_of_a_pi_controlled_mass_match_its_cubic() {
    let bounds = run(&read(&controlled("{ value: 60, tolerance: 15% }", "")));
    let [lag, pair] = cubic(60.0)[..] else { panic!("a lag and a pair") };
    are(&bounds, &[lag, pair], 1e-10);
    // In the mode of s the integral is −x/s.
    close(value(&bounds, "mode1.shape.x"), -lag.re, 1e-9);
    close(value(&bounds, "mode2.shape.integral"), (-1.0 / pair).re, 1e-9);
    for method in [Method::Chebyshev, Method::Scan] {
        // The slow lag gets faster, and the vibration less damped, with the gain.
        for (name, at) in [
            ("mode1.time_constant", [69.0, 51.0].map(|ki| -1.0 / cubic(ki)[0].re)),
            ("mode2.growth", [51.0, 69.0].map(|ki| cubic(ki)[1].re)),
            ("growth", [51.0, 69.0].map(|ki| cubic(ki)[1].re)),
        ] {
            let [lower, upper, error] = ends(&bounds, name, method);
            assert!((lower - at[0]).abs() <= error + 1e-10, "{method:?} {name} {lower} {} {error}", at[0]);
            assert!((upper - at[1]).abs() <= error + 1e-10, "{method:?} {name} {upper} {} {error}", at[1]);
            assert!(error < 1e-3 * (upper - lower), "{method:?} {name} {error}");
        }
    }
}

#[test]
fn limit_of_stability_matches_hurwitz() {
    // 2 s³ + 4 s² + 70 s + ki is stable up to ki = 4·70/2, where it vibrates with √35 rad/s.
    let limit = 140.0;
    for (ki, sign) in [(limit * (1.0 - 1e-8), -1.0), (limit * (1.0 + 1e-8), 1.0)] {
        let text = controlled(&format!("{ki}"), "modes: { at: equilibrium }");
        let (bounds, summary) = ran(study_of(&text));
        let growth = value(&bounds, "growth");
        // dσ/dki from the cubic: −1/(6 s² + 8 s + 70) at s = i√35.
        let slope = (-1.0 / Complex::new(70.0 - 210.0, 8.0 * 35.0_f64.sqrt())).re;
        close(growth, slope * sign * limit * 1e-8, 1e-3);
        close(TAU * value(&bounds, "mode2.frequency"), 35.0_f64.sqrt(), 1e-9);
        assert_eq!(summary.analysis.unwrap().growth, Some(growth));
    }
}

#[test]
fn integral_with_negative_gain_is_unstable() {
    // With a negative gain an eigenvalue is positive: the time constant is that of growth, and negative.
    let bounds = nominal(&read(&controlled("-30", "")));
    let roots = cubic(-30.0);
    are(&bounds, &roots, 1e-10);
    assert!(roots[0].re > 0.0 && value(&bounds, "mode1.time_constant") < 0.0);
    // With none it rests anywhere: it neither decays nor grows, and counts for nothing.
    let bounds = nominal(&read(&controlled("0", "")));
    assert_eq!(value(&bounds, "mode1.growth"), 0.0);
    assert!(value(&bounds, "mode1.time_constant").is_nan());
    close(value(&bounds, "growth"), -1.0, 1e-11);
}

#[test]
fn dc_motor_has_an_electric_and_a_mechanical_lag() {
    // L i̇ = −R i − k N ω, J ω̇ = k N i − b ω; the angle is free.
    let text = |inductance: f64| {
        format!(
            "
analysis: modes
bodies: {{ rotor: {{ mass: 1, inertia: 0.02 }} }}
joints: {{ hinge: {{ revolute: [ground, rotor] }} }}
effects:
  drive: {{ dc_motor: {{ on: hinge, voltage: 0, resistance: 2, inductance: {inductance}, constant: 0.3, ratio: 2 }} }}
  rub: {{ torsional_spring_damper: {{ on: hinge, stiffness: 0, damping: 0.05 }} }}
outputs: {{ current: drive.current, angle: rotor.angle }}
"
        )
    };
    for inductance in [0.01, 0.2] {
        let polynomial = [0.02 * inductance, 0.05 * inductance + 2.0 * 0.02, 2.0 * 0.05 + 0.36];
        let bounds = nominal(&read(&text(inductance)));
        let [a, b, c] = polynomial;
        assert_eq!(
            b * b > 4.0 * a * c,
            inductance < 0.1,
            "two lags with the small one, a vibration with the large one"
        );
        assert_eq!(value(&bounds, "mode1.growth"), 0.0);
        let found = one_of_each(roots(&polynomial));
        for (index, root) in found.iter().enumerate() {
            close(value(&bounds, &format!("mode{}.growth", index + 2)), root.re, 1e-10);
        }
        close(value(&bounds, "growth"), found[0].re, 1e-10);
    }
}

#[test]
fn poles_of_a_filter_do_not_depend_on_its_input() {
    // A Butterworth filter of order 4 at 3 Hz, and one that is its double: repeated poles keep their accuracy, since
    // neither depends on the other.
    let w = TAU * 3.0;
    let b = [1.0, 2.613_125_929_752_753, 3.414_213_562_373_095, 2.613_125_929_752_753, 1.0];
    let denominator: Vec<String> =
        b.iter().enumerate().map(|(index, b)| format!("{:e} s^{}", b / w.powi(4 - index as i32), 4 - index)).collect();
    let denominator = denominator.join(", ").replace(" s^0", "");
    let text = format!(
        "
analysis: modes
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, m], along: x, stiffness: 50, damping: 2, free_length: 0 }} }}
  felt: {{ filter: {{ input: m.x, numerator: [1], denominator: [{denominator}] }} }}
  again: {{ filter: {{ input: felt, numerator: [1], denominator: [{denominator}] }} }}
outputs: {{ x: m.x, felt: felt, again: again }}
"
    );
    let bounds = nominal(&read(&text));
    close(TAU * value(&bounds, "mode1.frequency"), 5.0, 1e-12);
    close(value(&bounds, "mode1.damping"), 0.1, 1e-12);
    let mut damping: Vec<f64> = (2..=5).map(|mode| value(&bounds, &format!("mode{mode}.damping"))).collect();
    (2..=5).for_each(|mode| close(value(&bounds, &format!("mode{mode}.frequency")), 3.0, 1e-10));
    damping.sort_by(f64::total_cmp);
    let [low, high] = [1.0_f64, 3.0].map(|part| (part * std::f64::consts::PI / 8.0).sin());
    damping.iter().zip([low, low, high, high]).for_each(|(found, wanted)| close(*found, wanted, 1e-10));
    // The filter passes the vibration of 5 rad/s by its transfer function.
    let s = Complex::new(-0.5, 24.75_f64.sqrt()) / w;
    let passed = 1.0 / b.iter().fold(Complex::new(0.0, 0.0), |sum, b| sum * s + b);
    assert!(passed.norm() > 1.0, "the vibration decays, so that what follows it late is larger");
    close(value(&bounds, "mode1.shape.felt"), (1.0 / passed).re, 1e-9);
    close(value(&bounds, "mode1.shape.x"), (1.0 / (passed * passed)).re, 1e-9);
}

#[test]
fn limit_of_stability_of_a_delayed_loop_is_exact() {
    // ẏ = −k y(t − T) vibrates without damping at k T = π/2, with a period of 4 T; Padé's approximation of order 8 is
    // that to rounding there.
    let text = |gain: f64| {
        format!(
            "
analysis: modes
modes: {{ number: 1 }}
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
states: {{ y: {{ rate: -{gain}*late/(1 s), initial: 0 }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, m], along: x, stiffness: 5000, damping: 100, free_length: 0 }} }}
  late: {{ delay: {{ input: y, time: 0.2 s, order: 8 }} }}
outputs: {{ y: y }}
"
        )
    };
    let limit = std::f64::consts::PI / 2.0 / 0.2;
    for (gain, is_stable) in [(limit * (1.0 - 1e-8), true), (limit * (1.0 + 1e-8), false)] {
        let bounds = nominal(&read(&text(gain)));
        close(value(&bounds, "mode1.frequency"), 1.0 / 0.8, 1e-7);
        assert_eq!(value(&bounds, "growth") < 0.0, is_stable, "{}", value(&bounds, "growth"));
    }
}

#[test]
fn a_response_goes_through_the_controller() {
    let more = "modes: { responses: { push: { load: x, output: x, from: 0.2, to: 2, points: 7 }, held: { load: x, output: integral, from: 0.2, to: 2, points: 7 } } }";
    let bounds = run(&read(&controlled("{ value: 60, tolerance: 10% }", more)));
    assert_eq!(bounds.responses.len(), 14);
    for point in &bounds.responses {
        let s = Complex::new(0.0, TAU * point.frequency);
        let response = |ki: f64| {
            let x = s / (s * s * s * 2.0 + s * s * 4.0 + s * 70.0 + ki);
            if point.name == "held" { -x / s } else { x }
        };
        close(point.amplitude.nominal[0], response(60.0).norm(), 1e-10);
        let turns = (point.phase.nominal[0] - response(60.0).arg()) / TAU;
        assert!((turns - turns.round()).abs() < 1e-10, "{turns}");
        let most = (0..=200).map(|place| response(54.0 + 0.06 * f64::from(place)).norm()).fold(0.0, f64::max);
        let chebyshev = point.amplitude.bands.iter().find(|band| band.method == Method::Chebyshev).unwrap();
        assert!((chebyshev.upper[0] - most).abs() <= chebyshev.error.total[0] + 1e-7, "{} {most}", chebyshev.upper[0]);
    }
}

#[test]
fn pairs_of_roots_are_followed_through_coincidence() {
    // m ẍ + c ẋ + k x = 0 with a filter that listens, and a loop of two lags: s² + 5 s + g, real up to g = 6.25.
    let text = |damping: &str, gain: &str| {
        format!(
            "
analysis: modes
parameters: {{ c: {damping}, g: {gain} }}
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
states:
  a: {{ rate: -2*a/(1 s) - b/(1 s), initial: 0 }}
  b: {{ rate: (g - 6)*a/(1 s) - 3*b/(1 s), initial: 0 }}
effects:
  spring: {{ spring_damper: {{ between: [ground, m], along: x, stiffness: 50, damping: c, free_length: 0 }} }}
  felt: {{ filter: {{ input: m.x, numerator: [1], denominator: [0.01 s, 1] }} }}
outputs: {{ x: m.x, felt: felt, a: a }}
bounds: {{ chebyshev: {{ order: 5 }}, scan: {{ points: 11 }} }}
"
        )
    };
    // Critical damping, 20, lies within.
    let bounds = run(&read(&text("{ value: 18, tolerance: 5 }", "5")));
    for method in [Method::Chebyshev, Method::Scan] {
        let [lower, upper, error] = ends(&bounds, "mode3.damping", method);
        assert!(
            (lower - 13.0 / 20.0).abs() < error + 1e-6 && (upper - 23.0 / 20.0).abs() < error + 1e-6,
            "{lower} {upper} {error}"
        );
        let [lower, upper, error] = ends(&bounds, "mode3.frequency", method);
        assert!(
            upper - lower < 1e-6 + 2.0 * error && (TAU * lower - 5.0).abs() < TAU * error + 1e-6,
            "{lower} {upper} {error}"
        );
    }
    // Nominally two lags with (5 ± √5)/2; beyond g = 6.25 both have −5/2.
    let bounds = run(&read(&text("8", "{ value: 5, interval: [4, 7] }")));
    let lags = |g: f64| [-1.0, 1.0].map(|sign| -2.5 - 0.5 * sign * (25.0 - 4.0 * g).max(0.0).sqrt());
    for (mode, index) in [(1, 0), (2, 1)] {
        close(value(&bounds, &format!("mode{mode}.growth")), lags(5.0)[index], 1e-10);
        let [lower, upper, _] = ends(&bounds, &format!("mode{mode}.growth"), Method::Scan);
        let wanted = [4.0, 7.0].map(|g| lags(g)[index]);
        close(lower, wanted[0].min(wanted[1]), 1e-6);
        close(upper, wanted[0].max(wanted[1]), 1e-6);
        // It is not smooth, and the error of the polynomial says so.
        let [_, _, error] = ends(&bounds, &format!("mode{mode}.growth"), Method::Chebyshev);
        assert!(error > 1e-3, "{error}");
    }
}
