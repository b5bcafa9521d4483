//! Impacts: a ball that bounces, a loose pin, and the order of errors at events. The references are closed forms, and
//! the same laws in minimal coordinates solved by another method whose steps fall at events.

use mbint::results::Method;

use crate::common::dormand_prince::dormand_prince;
use crate::common::restitution::restitution;
use crate::common::{Subject, band, curve, largest, nominal, order, output, read, run, run_methods};

/// Largest errors of an output against a curve at the output times, for some steps.
pub(super) fn errors_of_steps(description: &Subject, name: &str, truth: &[f64], steps: &[f64]) -> Vec<f64> {
    let error = |&h: &f64| {
        let bounds = nominal(&description.clone().step(h));
        let error = largest(curve(&bounds, name).iter().zip(truth).map(|(value, truth)| value - truth));
        println!("h = {h:.2e} s: {name} off by {error:.2e}");
        error
    };
    let errors: Vec<f64> = steps.iter().map(error).collect();
    println!("orders {:.2?}", errors.windows(2).map(|pair| order(pair[0], pair[1])).collect::<Vec<_>>());
    errors
}

/// The same for some tolerances: each error is below `times` times the tolerance, and the last is below the first.
pub(super) fn errors_within(description: &Subject, name: &str, truth: &[f64], tolerances: &[f64], times: f64) {
    let mut errors = Vec::new();
    for &tolerance in tolerances {
        let (bounds, summary) = run_methods(&description.clone().tolerance(tolerance), Some(Vec::new()));
        let error = largest(curve(&bounds, name).iter().zip(truth).map(|(value, truth)| value - truth));
        println!("tolerance {tolerance:.0e}: {} steps, {name} off by {error:.2e}", summary.methods[0].steps);
        assert!(error < times * tolerance, "{error:e}");
        errors.push(error);
    }
    assert!(errors.last() < errors.first(), "{errors:?}");
}

/// A step, and its halves.
pub(super) fn halved(h: f64, count: i32) -> Vec<f64> {
    (0..count).map(|level| h * 0.5_f64.powi(level)).collect()
}

/// Once events are resolved, the order is two: that of the last two halvings.
#[track_caller]
pub(super) fn settles_at_order_two(errors: &[f64]) {
    let late = &errors[errors.len() - 3..];
    let orders = late.windows(2).map(|pair| order(pair[0], pair[1]));
    assert!(orders.clone().all(|order| (order - 2.0).abs() < 0.3), "{errors:?}");
    assert!(late[2] < 0.1 * errors[0], "{errors:?}");
}

/// Bounds by Chebyshev polynomials and by a scan contain some samples of the truth, within the errors that they report.
/// `allowed` is the largest error of ends, relative to the widest range.
pub(super) fn bounds_hold(description: Subject, name: &str, truths: &[Vec<f64>], allowed: f64) {
    let description = description.asking(|study| study.chebyshev(12).scan(41));
    let bounds = run(&description);
    let rows = bounds.times.len();
    let range = |row: usize| {
        let values = truths.iter().map(|truth| truth[row]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let widest = (0..rows).map(|row| range(row).1 - range(row).0).fold(0.0, f64::max);
    for method in [Method::Chebyshev, Method::Scan] {
        let band = band(output(&bounds, name), method);
        let (mut held, mut off) = (0, 0.0_f64);
        for row in 0..rows {
            let ((low, high), error) = (range(row), band.error.total[row]);
            off = off.max((band.lower[row] - low).abs()).max((band.upper[row] - high).abs());
            let missed = (band.lower[row] - low).max(high - band.upper[row]) - error;
            // Rounding.
            held += usize::from(missed <= 1e-12 * widest);
        }
        let share = held as f64 / rows as f64;
        println!(
            "{name}.{}: {:.1} % of the rows hold the truth; ends off by {:.1e} of the widest",
            method.name(),
            100.0 * share,
            off / widest
        );
        assert!(off < allowed * widest, "{name}.{}: {off:e} of {widest:e}", method.name());
        assert!(share >= 0.99, "{name}.{}: {share}", method.name());
    }
}

/// n points from a to b, both included.
pub(super) fn points(a: f64, b: f64, n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |i| a + (b - a) * i as f64 / (n - 1) as f64)
}

// --- A ball that bounces.

pub(super) const G: f64 = 9.81;

/// It falls from 1 m on a floor that keeps `e` of the speed by Hunt and Crossley's formula.
fn ball(stiffness: f64, run: &str) -> Subject {
    read(&format!(
        "
parameters: {{ e: {{ value: 0.8, tolerance: 2.5% }} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -{G}] }} }}
  floor:
    contact:
      {{ between: [ground, ball], plane: y, impact: {{ stiffness: {stiffness:e}, restitution: e, impact_velocity: sqrt(2*{G}), law: hunt_crossley }} }}
initial: {{ ball.y: 1, ball.vy: 0 }}
outputs: {{ y: ball.y, energy: energy }}
simulation: {{ {run} }}
"
    ))
}

/// Its height and velocity, one row each `output_step`.
fn bounces(stiffness: f64, e: f64, output_step: f64, rows: usize) -> Vec<[f64; 2]> {
    let dissipation = 1.5 * (1.0 - e) / (2.0 * G).sqrt();
    let law = |_: f64, [y, v]: [f64; 2]| {
        let push = stiffness * (-y).max(0.0).powf(1.5) * (1.0 - dissipation * v).max(0.0);
        [v, push - G]
    };
    dormand_prince(law, [1.0, 0.0], output_step, rows, 1e-13)
}

/// After each bounce the ball has e² of the energy, e by the speed of the impact.
#[test]
fn a_bouncing_ball_has_the_energies_of_its_restitutions() {
    let description = ball(1e9, "duration: 3, step: 1e-4, output_step: 1e-3");
    let dissipation = 1.5 * 0.2 / (2.0 * G).sqrt();
    // Energies where nothing touches, in the middle of each flight.
    let mut expected = Vec::new();
    let (mut height, mut time) = (1.0_f64, (2.0 / G).sqrt());
    while time < 2.5 {
        let e = restitution(dissipation * (2.0 * G * height).sqrt());
        height *= e * e;
        let rise = (2.0 * height / G).sqrt();
        expected.push((time + rise, G * height));
        time += 2.0 * rise;
    }
    assert_eq!(expected.len(), 4);
    // Work of the weight during the contact: δ of the height.
    let exact = bounces(1e9, 0.8, 1e-3, 3001);
    let rows: Vec<usize> = expected.iter().map(|&(time, _)| (time * 1e3).round() as usize).collect();
    let exact: Vec<f64> = rows.iter().map(|&row| 0.5 * exact[row][1].powi(2) + G * exact[row][0]).collect();
    let apart = largest(exact.iter().zip(&expected).map(|(exact, (_, expected))| exact / expected - 1.0));
    println!("the closed form of an impact without weight is off by {apart:.1e}");
    assert!(apart < 2e-3);
    let mut errors = Vec::new();
    // The contact lasts 0.6 ms; the first two step over it.
    for h in [1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6] {
        let bounds = nominal(&description.clone().step(h));
        let energy = curve(&bounds, "energy");
        let off: Vec<f64> = rows.iter().zip(&exact).map(|(&row, exact)| energy[row] / exact - 1.0).collect();
        let shown: Vec<String> = off.iter().map(|off| format!("{off:.1e}")).collect();
        println!("h = {h:.2e} s: energies off by {}", shown.join(", "));
        errors.push(largest(off));
        if h <= 2e-4 {
            let gained = rows.windows(2).map(|pair| energy[pair[1]] / energy[pair[0]]).fold(0.0, f64::max);
            assert!(energy[rows[0]] < energy[0] && gained < 1.0, "{h:e}: {gained}");
        }
    }
    assert!(errors[7] < 1e-3 && errors[7] < 0.1 * errors[4], "{errors:?}");
}

#[test]
#[ignore = "20 s: steps that resolve impacts"]
fn a_bouncing_ball_converges() {
    let description = ball(1e7, "duration: 2, step: 1e-4, output_step: 0.01");
    let truth: Vec<f64> = bounces(1e7, 0.8, 0.01, 201).iter().map(|y| y[0]).collect();
    settles_at_order_two(&errors_of_steps(&description, "y", &truth, &halved(1e-3, 7)));
    errors_within(&description, "y", &truth, &[1e-4, 1e-5, 1e-6, 1e-7], 4.0);
}

#[test]
fn bounds_of_a_bouncing_ball_hold() {
    let truths: Vec<Vec<f64>> =
        points(0.78, 0.82, 41).map(|e| bounces(1e7, e, 0.02, 76).iter().map(|y| y[0]).collect()).collect();
    bounds_hold(ball(1e7, "duration: 1.5, step: 1e-4, output_step: 0.02"), "y", &truths, 0.02);
}

// --- A slider crank with a loose pin.

const CRANK: f64 = 0.05;
const ROD: f64 = 0.12;
const SPEED: f64 = std::f64::consts::TAU;

fn loose_pin(run: &str) -> Subject {
    read(&format!(
        "
parameters:
  c: {{ value: 0.1, unit: mm, tolerance: 20% }}
  theta: 60 deg
  phi: asin({CRANK}*sin(theta)/{ROD})
  phi_rate: {SPEED}*{CRANK}*cos(theta)/({ROD}*cos(phi))
bodies:
  crank: {{ mass: 0.3, inertia: 1e-4, points: {{ A: [{}, 0], B: [{0}*(-1), 0] }} }}
  rod: {{ mass: 0.21, inertia: 2.5e-4, points: {{ B: [{}, 0], C: [{1}*(-1), 0] }} }}
  slider: {{ mass: 0.14, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  drive: {{ motor: {{ on: pivot, speed: {SPEED} rad/s, from: theta }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -{G}] }} }}
  wrist:
    clearance_joint:
      {{ between: [slider, rod.C], clearance: c, radius: 5 mm, impact: {{ stiffness: 1e9, dissipation: 15 }} }}
initial:
  rod.angle: -phi
  rod.angular_velocity: -phi_rate
  slider.x: {CRANK}*cos(theta) + {ROD}*cos(phi)
  slider.vx: -{CRANK}*{SPEED}*sin(theta) - {ROD}*phi_rate*sin(phi)
guess: {{ crank.angle: theta }}
outputs: {{ x: slider.x, gap: wrist.gap, force: wrist.force }}
simulation: {{ {run} }}
",
        -0.5 * CRANK,
        -0.5 * ROD,
    ))
}

/// Position of the slider: the rod's angle and this position are the only freedoms.
fn loose_slider(clearance: f64, output_step: f64, rows: usize) -> Vec<f64> {
    let (mass, inertia, sliding) = (0.21, 2.5e-4, 0.14);
    let about_pin = inertia + mass * 0.25 * ROD * ROD;
    let theta = 60.0_f64.to_radians();
    let phi = (CRANK * theta.sin() / ROD).asin();
    let phi_rate = SPEED * CRANK * theta.cos() / (ROD * phi.cos());
    let law = |t: f64, [a, x, spin, v]: [f64; 4]| {
        let (s, c) = (theta + SPEED * t).sin_cos();
        let (along, beside) = ([a.cos(), a.sin()], [-a.sin(), a.cos()]);
        let d = [CRANK * c + ROD * along[0] - x, CRANK * s + ROD * along[1]];
        let rate = [-CRANK * SPEED * s + ROD * spin * beside[0] - v, CRANK * SPEED * c + ROD * spin * beside[1]];
        let distance = (d[0] * d[0] + d[1] * d[1] + (1e-4 * clearance).powi(2)).sqrt();
        let n = [-d[0] / distance, -d[1] / distance];
        let approach = -(n[0] * rate[0] + n[1] * rate[1]);
        let push = 1e9 * (distance - clearance).max(0.0).powf(1.5) * (1.0 + 15.0 * approach).max(0.0);
        let carried = mass * SPEED * SPEED * CRANK * 0.5 * ROD * (c * beside[0] + s * beside[1]);
        let moment = carried - mass * G * 0.5 * ROD * beside[1] + ROD * push * (n[0] * beside[0] + n[1] * beside[1]);
        [spin, v, moment / about_pin, -push * n[0] / sliding]
    };
    let x = CRANK * theta.cos() + ROD * phi.cos();
    let v = -CRANK * SPEED * theta.sin() - ROD * phi_rate * phi.sin();
    let solution = dormand_prince(law, [-phi, x, -phi_rate, v], output_step, rows, 1e-14);
    solution.iter().map(|y| y[1]).collect()
}

#[test]
#[ignore = "30 s: steps that resolve impacts"]
fn a_slider_crank_with_clearance_converges() {
    let description = loose_pin("duration: 0.1, step: 1e-4, output_step: 1e-3");
    let truth = loose_slider(1e-4, 1e-3, 101);
    settles_at_order_two(&errors_of_steps(&description, "x", &truth, &halved(2e-4, 7)));
    errors_within(&description, "x", &truth, &[1e-6, 1e-7, 1e-8], 0.1);
}

#[test]
fn slider_crank_with_clearance_stays_accurate() {
    let bounds = nominal(&loose_pin("duration: 2, step: 1e-4, output_step: 1e-3"));
    let truth = loose_slider(1e-4, 1e-3, 2001);
    let off: Vec<f64> = curve(&bounds, "x").iter().zip(&truth).map(|(x, truth)| (x - truth).abs()).collect();
    println!(
        "off by {:.1e} in 0.1 s, {:.1e} in 2 s",
        largest(off[..100].iter().copied()),
        largest(off.iter().copied())
    );
    assert!(largest(off) < 1e-5);
    // The depth is that of the largest force.
    let gaps = curve(&bounds, "gap");
    let (deepest, loosest) = (-gaps.iter().copied().fold(0.0, f64::min), gaps.iter().copied().fold(0.0, f64::max));
    let force = largest(curve(&bounds, "force").iter().copied());
    println!("as deep as {deepest:.2e} m, forces to {force:.1} N");
    assert!(deepest < 1.2 * (force / 1e9).powf(2.0 / 3.0) && force < 100.0 && loosest <= 1e-4);
}

#[test]
#[ignore = "2 s"]
fn bounds_of_a_slider_crank_with_clearance_hold() {
    let truths: Vec<Vec<f64>> = points(0.8e-4, 1.2e-4, 41).map(|c| loose_slider(c, 1e-3, 101)).collect();
    bounds_hold(loose_pin("duration: 0.1, step: 2e-5, output_step: 1e-3"), "x", &truths, 3e-3);
}

// --- Order of errors with events.

/// Mean errors over many positions of an event within a step, for steps that are halved.
fn mean_errors(case: impl Fn(f64) -> (Subject, f64), steps: &[f64]) -> Vec<f64> {
    let phases = 30;
    let mean = |&h: &f64| {
        let errors = (0..phases).map(|phase| {
            let (description, exact) = case((f64::from(phase) * 0.618_033_988_749_895).fract());
            (curve(&nominal(&description.step(h)), "x").last().unwrap() - exact).abs()
        });
        errors.sum::<f64>() / f64::from(phases)
    };
    let errors: Vec<f64> = steps.iter().map(mean).collect();
    let orders: Vec<f64> = errors.windows(2).map(|pair| order(pair[0], pair[1])).collect();
    let shown: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("errors {}, orders {orders:.2?}", shown.join(", "));
    errors
}

/// Forces that jump leave order one: a step that they fall into takes them for all of it or for none. Forces with a
/// kink, as of a linear stop, leave order two.
#[test]
fn jumps_leave_order_one_and_kinks_order_two() {
    let jump = |phase: f64| {
        let at = 0.3 + 0.01 * phase;
        let text = format!(
            "bodies: {{ block: {{ mass: 1, coordinates: [x] }} }}
effects: {{ push: {{ force: {{ on: block, value: [0.5*(1 + sign(t - {at})), 0] }} }} }}
initial: {{ block.x: 0, block.vx: 0 }}
outputs: {{ x: block.x }}
simulation: {{ duration: 0.6, step: 1e-3, output_step: 0.1 }}
"
        );
        (read(&text), 0.5 * (0.6 - at).powi(2))
    };
    let kink = |phase: f64| {
        let apart = 0.3 + 0.01 * phase;
        let text = format!(
            "bodies: {{ block: {{ mass: 1, coordinates: [x] }} }}
effects: {{ stop: {{ force: {{ on: block, value: [\"1e4*max(0, -block.x)\", 0] }} }} }}
initial: {{ block.x: {apart}, block.vx: -1 }}
outputs: {{ x: block.x }}
simulation: {{ duration: 0.6, step: 1e-3, output_step: 0.1 }}
"
        );
        (read(&text), 0.6 - apart - std::f64::consts::PI / 100.0)
    };
    let jumps = mean_errors(jump, &halved(1e-2, 5));
    let kinks = mean_errors(kink, &halved(2e-3, 5));
    let overall = |errors: &[f64]| 0.25 * order(errors[0], errors[4]);
    assert!((overall(&jumps) - 1.0).abs() < 0.2, "{jumps:?}");
    assert!((overall(&kinks) - 2.0).abs() < 0.3, "{kinks:?}");
}
