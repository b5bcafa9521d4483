//! Whether bounds are honest where their range is hard to find: bands full of turns, sums of independent oscillators,
//! peaks that are narrow, responses with kinks and jumps. The truths are closed forms, ranged over dense samples or by
//! hand.
//!
//! A row counts unless its band is flagged; both ends have to be within the stated error in 99 % of those that count.

use std::f64::consts::PI;

use mbint::results::{Bounds, Method};

use crate::common::runge_kutta::runge_kutta;
use crate::common::{Subject, band, output, read, run};

/// Rows that are not flagged, the share of them that is covered, and the mean of the stated over the mean of the true
/// errors.
fn honesty(bounds: &Bounds, name: &str, method: Method, truth: impl Fn(f64) -> (f64, f64)) -> (usize, f64, f64) {
    let band = band(output(bounds, name), method);
    let (mut counted, mut covered, mut stated, mut errors) = (0, 0, 0.0, 0.0);
    for (row, &t) in bounds.times.iter().enumerate().filter(|(row, _)| !band.error.unresolved[*row]) {
        let (lower, upper) = truth(t);
        let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
        counted += 1;
        covered += usize::from(error <= band.error.total[row]);
        (stated, errors) = (stated + band.error.total[row], errors + error);
        if error > band.error.total[row] {
            println!(
                "{name} at {t}: off by {error:.2e}, stated {:.2e}, of {:.2e}",
                band.error.total[row],
                upper - lower
            );
        }
    }
    let shares = (covered as f64 / counted.max(1) as f64, stated / errors);
    println!(
        "{name}.{}: {counted} of {} rows, {:.3}, {:.2} times",
        method.name(),
        bounds.times.len(),
        shares.0,
        shares.1
    );
    (counted, shares.0, shares.1)
}

#[track_caller]
pub fn assert_honest(bounds: &Bounds, name: &str, method: Method, truth: impl Fn(f64) -> (f64, f64)) -> usize {
    let (counted, covered, _) = honesty(bounds, name, method, truth);
    // Nothing is asserted if all rows are flagged.
    assert!(counted == 0 || covered >= 0.99, "{name}.{}: {covered} of {counted} rows", method.name());
    counted
}

/// a cos φ over phases.
pub fn cosine(a: f64, from: f64, to: f64) -> (f64, f64) {
    let turns = (from / PI).ceil() as i64..=(to / PI).floor() as i64;
    let extremes = turns.map(|turn| if turn % 2 == 0 { a } else { -a });
    let values = extremes.chain([a * from.cos(), a * to.cos()]);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), v| (lower.min(v), upper.max(v)))
}

/// Oscillators of unit mass about `origin`: amplitude, stiffness and its tolerance of each.
pub fn oscillators(parts: &[(f64, f64, f64)], outputs: &str, origin: f64, settings: &str) -> Subject {
    let each = |text: fn(usize, (f64, f64, f64), f64) -> String| -> String {
        parts.iter().enumerate().map(|(i, &part)| text(i, part, origin)).collect()
    };
    let parameters = each(|i, (_, k, share), _| format!("  k{i}: {{ value: {k}, unit: N/m, tolerance: {share}% }}\n"));
    let bodies = each(|i, _, _| format!("  b{i}: {{ mass: 1 kg, coordinates: [x] }}\n"));
    let forces = each(|i, _, origin| {
        format!("  s{i}: {{ force: {{ on: b{i}, value: [\"-k{i}*(b{i}.x - {origin})\", 0] }} }}\n")
    });
    let initial = each(|i, (a, ..), origin| format!("  b{i}.x: {}\n  b{i}.vx: 0\n", a + origin));
    read(&format!(
        "parameters:\n{parameters}bodies:\n{bodies}effects:\n{forces}initial:\n{initial}outputs: {outputs}\n{settings}"
    ))
}

/// The range of Σ aᵢ cos(√kᵢ t).
pub fn sum(parts: &[(f64, f64, f64)], t: f64) -> (f64, f64) {
    let range = |&(a, k, share): &(f64, f64, f64)| {
        let phase = |sign: f64| (k * (1.0 + sign * share / 100.0)).sqrt() * t;
        cosine(a, phase(-1.0), phase(1.0))
    };
    parts.iter().map(range).fold((0.0, 0.0), |(l, u), (lower, upper)| (l + lower, u + upper))
}

#[test]
#[ignore = "10 s: dense scans"]
fn sums_of_independent_oscillators_are_covered() {
    let parts = [(0.12, 1.1, 17.0), (0.05, 2.0, 14.0), (0.08, 0.7, 18.0), (0.03, 1.5, 12.0)];
    let settings = "simulation: { duration: 30, step: 0.005, output_step: 0.5 }\nbounds: { chebyshev: { order: 6 } }\n";
    let description = oscillators(&parts, "{ x: b0.x + b1.x + b2.x + b3.x }", 0.0, settings);
    assert!(assert_honest(&run(&description), "x", Method::Chebyshev, |t| sum(&parts, t)) > 50);
    let (parts, outputs) = (&parts[..3], "{ x: b0.x + b1.x + b2.x, y: 3*b0.x - b2.x }");
    let settings = settings.replace("order: 6", "order: 11").replace("duration: 30", "duration: 50");
    let bounds = run(&oscillators(parts, outputs, 0.0, &settings));
    assert!(assert_honest(&bounds, "x", Method::Chebyshev, |t| sum(parts, t)) > 80);
    let weighted = [(3.0 * parts[0].0, parts[0].1, parts[0].2), (-parts[2].0, parts[2].1, parts[2].2)];
    assert_honest(&bounds, "y", Method::Chebyshev, |t| sum(&weighted, t));
}

/// Outputs that turn several times while the coordinate moves once.
#[test]
fn sums_of_waves_in_the_coordinates_are_covered() {
    let parts = [(0.1, 1.3, 9.0), (0.1, 0.8, 11.0)];
    let settings = "simulation: { duration: 20, step: 0.01, output_step: 0.25 }\nbounds: { chebyshev: { order: 9 } }\n";
    let outputs = "{ s: \"sin(70*b0.x) + 0.7*cos(55*b1.x + 1)\", p: \"sin(40*b0.x)*(1 + b1.x)\" }";
    let bounds = run(&oscillators(&parts, outputs, 0.0, settings));
    let ranged = |f: &dyn Fn(f64) -> f64, (lower, upper): (f64, f64)| {
        let values = (0..=20_000).map(|i| f(lower + (upper - lower) * f64::from(i) / 20_000.0));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)))
    };
    let truth = |t: f64| {
        let sine = ranged(&|x| (70.0 * x).sin(), sum(&parts[..1], t));
        let cosine = ranged(&|x| 0.7 * (55.0 * x + 1.0).cos(), sum(&parts[1..], t));
        (sine.0 + cosine.0, sine.1 + cosine.1)
    };
    assert!(assert_honest(&bounds, "s", Method::Chebyshev, truth) > 70);
    let truth = |t: f64| {
        let (sine, factor) = (ranged(&|x| (40.0 * x).sin(), sum(&parts[..1], t)), sum(&parts[1..], t));
        let products = [sine.0, sine.1].into_iter().flat_map(|s| [s * (1.0 + factor.0), s * (1.0 + factor.1)]);
        products.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)))
    };
    assert!(assert_honest(&bounds, "p", Method::Chebyshev, truth) > 70);
}

/// m x'' = −k x − c v + cos(w t) from rest.
fn forced(k: f64, c: f64, w: f64, t: f64) -> f64 {
    let denominator = (k - w * w).powi(2) + (c * w).powi(2);
    let (a, b) = ((k - w * w) / denominator, c * w / denominator);
    let decay = 0.5 * c;
    let free = (k - decay * decay).sqrt();
    let fade = (-decay * t).exp();
    a * (w * t).cos()
        + b * (w * t).sin()
        + fade * (-a * (free * t).cos() - (decay * a + b * w) / free * (free * t).sin())
}

/// A resonance a fortieth as wide as the interval of the stiffness.
#[test]
fn a_narrow_resonance_is_covered_or_flagged() {
    let text = "
parameters: { k: { interval: [0.85, 1.2], unit: N/m } }
bodies: { m: { mass: 1 kg, coordinates: [x] } }
effects: { s: { force: { on: m, value: [\"-k*m.x - 0.009*m.vx + cos(0.98*t)\", 0] } } }
initial: { m.x: 0, m.vx: 0 }
outputs: { x: m.x }
simulation: { duration: 600, step: 0.02, output_step: 5 }
bounds: { chebyshev: { order: ORDER }, scan: { points: 24 } }
";
    for order in ["9", "14"] {
        let bounds = run(&read(&text.replace("ORDER", order)));
        let truth = |t: f64| {
            let values = (0..=4000).map(|i| forced(0.85 + 0.35 * f64::from(i) / 4000.0, 0.009, 0.98, t));
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)))
        };
        assert_honest(&bounds, "x", Method::Chebyshev, truth);
        assert_honest(&bounds, "x", Method::Scan, truth);
    }
}

/// Pendulums of which some go over the top and some do not: adjacent samples end up turns apart.
#[test]
fn a_scan_across_a_separatrix_is_covered_or_flagged() {
    let text = "
parameters: { w: { value: 6, unit: rad/s, tolerance: 6% } }
bodies: { bob: { mass: 1 kg, inertia: 0.1, points: { O: [-1, 0] } } }
joints: { pivot: { revolute: [ground, bob.O] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bob.angle: -90 deg, bob.angular_velocity: w }
outputs: { angle: bob.angle }
simulation: { duration: 4, step: 1e-3, output_step: 0.05 }
bounds: { scan: { points: 10 } }
";
    let rows = 81;
    let mut truth = vec![(f64::INFINITY, f64::NEG_INFINITY); rows];
    for i in 0..=1500 {
        let w = 6.0 * (1.0 + 0.06 * (f64::from(i) / 750.0 - 1.0));
        let solution = runge_kutta(|[a, u]| [u, -9.81 / 1.1 * a.cos()], [-0.5 * PI, w], 0.05, rows, 25);
        for ((lower, upper), [angle, _]) in truth.iter_mut().zip(solution) {
            (*lower, *upper) = (lower.min(angle), upper.max(angle));
        }
    }
    let bounds = run(&read(text));
    let counted = assert_honest(&bounds, "angle", Method::Scan, |t| truth[(t / 0.05).round() as usize]);
    assert!(counted > 10);
}

#[test]
fn kinks_are_covered() {
    let parts = [(0.1, 1.0, 20.0)];
    let settings = "simulation: { duration: 20, step: 0.01, output_step: 0.25 }\nbounds: { chebyshev: { order: 8 }, scan: { points: 12 } }\n";
    let outputs = "{ a: \"abs(b0.x)\", m: \"max(b0.x, 0.02)\", n: \"min(b0.x, 0) - 2*max(b0.x - 0.05, 0)\" }";
    let bounds = run(&oscillators(&parts, outputs, 0.0, settings));
    let of = |f: fn(f64) -> f64| {
        move |t: f64| {
            let (lower, upper) = sum(&parts, t);
            let values = (0..=10_000).map(|i| f(lower + (upper - lower) * f64::from(i) / 1e4));
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)))
        }
    };
    let kinks: [fn(f64) -> f64; 3] = [|x| x.abs(), |x| x.max(0.02), |x| x.min(0.0) - 2.0 * (x - 0.05).max(0.0)];
    for (name, f) in ["a", "m", "n"].into_iter().zip(kinks) {
        for method in [Method::Chebyshev, Method::Scan] {
            assert_honest(&bounds, name, method, of(f));
        }
    }
}

/// The difference of two motions changes its sign in a corner of the box only: elsewhere its magnitude is a sum of
/// functions of one parameter each.
#[test]
fn a_kink_in_a_corner_is_covered() {
    let parts = [(0.32, 1.21, 9.0), (0.11, 2.3, 5.0)];
    let settings = "simulation: { duration: 15, step: 5e-3, output_step: 0.25 }\nbounds: { chebyshev: { order: 7 } }\n";
    let bounds = run(&oscillators(&parts, "{ d: \"abs(b0.x - b1.x - 0.19)\" }", 0.0, settings));
    let counted = assert_honest(&bounds, "d", Method::Chebyshev, |t| {
        let mirrored = [parts[0], (-parts[1].0, parts[1].1, parts[1].2)];
        let (lower, upper) = sum(&mirrored, t);
        let (lower, upper) = (lower - 0.19, upper - 0.19);
        let least = if lower < 0.0 && upper > 0.0 { 0.0 } else { lower.abs().min(upper.abs()) };
        (least, lower.abs().max(upper.abs()))
    });
    assert_eq!(counted, 61);
}

/// A magnitude that is itself the polynomial: it is furthest off at its kink, where no validation sample is.
#[test]
fn kinks_of_expanded_outputs_are_covered() {
    let parts = [(0.9, 50.0, 23.0)];
    for order in [4, 5, 6] {
        let settings = format!(
            "simulation: {{ duration: 1.2, step: 5e-4, output_step: 0.01 }}\nbounds: {{ chebyshev: {{ order: {order}, expand: output }} }}\n"
        );
        let bounds = run(&oscillators(&parts, "{ a: \"abs(b0.x)\" }", 0.0, &settings));
        let counted = assert_honest(&bounds, "a", Method::Chebyshev, |t| {
            let (lower, upper) = sum(&parts, t);
            (if lower < 0.0 && upper > 0.0 { 0.0 } else { lower.abs().min(upper.abs()) }, lower.abs().max(upper.abs()))
        });
        assert!(counted > 15, "{counted}");
    }
}

/// Constant and zero outputs, with and without uncertain parameters.
#[test]
fn constant_outputs_are_resolved() {
    let parts = [(0.1, 1.0, 5.0)];
    let settings = "simulation: { duration: 5, step: 0.01, output_step: 0.1 }\nbounds: { chebyshev: { order: 4 }, scan: { points: 5 } }\n";
    let outputs = "{ one: b0.x/b0.x, zero: b0.x - b0.x, far: 1e6 + 1e-9*b0.x, still: b1.x, rate: b1.vx, a: b1.ax }";
    let mut description = oscillators(&[parts[0], (0.0, 2.0, 5.0)], outputs, 0.0, settings);
    for _ in 0..2 {
        let bounds = run(&description);
        for output in &bounds.outputs {
            for band in &output.bands {
                assert_eq!(band.error.unresolved_from(), None, "{}.{}", output.name, band.method.name());
            }
        }
        description = description.step(0.02);
    }
}
