//! Certified bounds of the true motion: they contain solutions by DOP853 of equations that were derived by hand, are
//! hardly wider than the ranges of these, and say where they end.

use mbint::Study;
use mbint::certificate::{Certificate, check};
use mbint::results::{Bounds, Method};
use rayon::prelude::*;

use crate::common::Subject;
use crate::common::dop853::solve;
use crate::common::measured::Case;
use crate::common::*;

/// Error of the reference: DOP853's tolerance, gathered over the steps.
const REFERENCE: f64 = 1e-11;

pub fn certify(description: Subject) -> (Bounds, Option<String>) {
    let (bounds, summary) = description.asking(Study::certified).finished(None);
    (bounds, summary.failure)
}

/// Asserts that the band of an output holds the values of samples, a row each; returns by how much it is wider at most.
#[track_caller]
pub fn excess(bounds: &Bounds, name: &str, samples: &[Vec<f64>]) -> f64 {
    let certified = band(output(bounds, name), Method::Certified);
    let mut worst = 0.0_f64;
    for row in 0..bounds.times.len() {
        let (lower, upper) = (certified.lower[row], certified.upper[row]);
        let values = samples.iter().map(|sample| sample[row]);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        let most = values.fold(f64::NEG_INFINITY, f64::max);
        let held = lower <= least + REFERENCE && most <= upper + REFERENCE;
        assert!(held, "{name} at {} s: [{least}, {most}] in [{lower}, {upper}]", bounds.times[row]);
        worst = worst.max((upper - lower) - (most - least));
    }
    worst
}

/// Notes a band that holds `solutions` solutions, and is hardly wider than their range.
#[track_caller]
fn held(case: &str, solutions: usize, excess: f64, allowed: f64) {
    let case = Case::new("certified", case)
        .source("DOP853 of equations derived by hand")
        .figure("solutions held", solutions as f64);
    case.at_most("band wider by, m", excess, allowed).note();
}

/// Numbers between −1 and 1, the ends first.
pub fn box_of(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |index| if index == 1 { 1.0 } else { -1.0 + 2.0 * index as f64 / count as f64 })
}

/// Two point masses on rods of 1 m, released at an uncertain angle; the example of MC++ and CRONOS.
fn two_bobs(duration: f64, step: &str) -> Subject {
    read(&format!(
        "
parameters: {{ p: {{ value: 1, tolerance: 0.5% }}, g: 9.81 }}
bodies:
  first: {{ mass: 1, inertia: 0, points: {{ top: [0, 1], bob: [0, 0] }} }}
  second: {{ mass: 1, inertia: 0, points: {{ top: [0, 1] }} }}
joints:
  upper: {{ revolute: [ground, first.top] }}
  lower: {{ revolute: [first.bob, second.top] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -g] }} }} }}
initial:
  first.angle: 0.75*pi*p
  first.angular_velocity: 0.43
  second.angle: -0.55*pi
  second.angular_velocity: 0.67
outputs: {{ x: second.x, y: second.y, speed: second.vx, lean: second.ax }}
simulation: {{ duration: {duration}, {step}, output_step: 0.1 }}
"
    ))
}

/// θ₁, θ₂ from straight down, and their rates (Lagrange's equations for equal masses on rods of 1 m).
fn two_bobs_by_hand(p: f64, times: &[f64]) -> Vec<[f64; 4]> {
    two_bobs_under(p, 9.81, 0.43, times)
}

/// The same with other accelerations of gravity and first rates.
fn two_bobs_under(p: f64, g: f64, rate: f64, times: &[f64]) -> Vec<[f64; 4]> {
    let pi = std::f64::consts::PI;
    let equation = |_: f64, y: &[f64], d: &mut [f64]| d.copy_from_slice(&rates_under(g, y));
    solve(equation, &[0.75 * pi * p, -0.55 * pi, rate, 0.67], times, 1e-14, 1e-2)
}

fn rates_of_two_bobs(y: &[f64]) -> [f64; 4] {
    rates_under(9.81, y)
}

fn rates_under(g: f64, y: &[f64]) -> [f64; 4] {
    let [a, b, u, v] = [y[0], y[1], y[2], y[3]];
    let (s, c) = (a - b).sin_cos();
    let first = -g * 2.0 * a.sin() - v * v * s;
    let second = -g * b.sin() + u * u * s;
    let determinant = 2.0 - c * c;
    [u, v, (first - c * second) / determinant, (2.0 * second - c * first) / determinant]
}

#[test]
fn solutions_of_the_double_pendulum_are_held() {
    // No step of the program's own matters.
    for step in ["step: 2e-3", "tolerance: 1e-4"] {
        let (bounds, failure) = certify(two_bobs(0.6, step));
        assert_eq!(failure, None);
        let solutions: Vec<_> = box_of(200).map(|xi| two_bobs_by_hand(1.0 + 5e-3 * xi, &bounds.times)).collect();
        let observed = |of: fn(&[f64]) -> f64| -> Vec<Vec<f64>> {
            solutions.iter().map(|rows| rows.iter().map(|y| of(y)).collect()).collect()
        };
        // The excess is due to the spacing of the samples, and to the proof.
        let of_x = excess(&bounds, "x", &observed(|y| y[0].sin() + y[1].sin()));
        held(&format!("double pendulum to 0.6 s, {step}"), solutions.len(), of_x, 1e-5);
        assert!(excess(&bounds, "y", &observed(|y| -y[0].cos() - y[1].cos())) < 1e-5);
        assert!(excess(&bounds, "speed", &observed(|y| y[2] * y[0].cos() + y[3] * y[1].cos())) < 1e-4);
        let lean = |y: &[f64]| {
            let [u, v, a, b] = rates_of_two_bobs(y);
            a * y[0].cos() - u * u * y[0].sin() + b * y[1].cos() - v * v * y[1].sin()
        };
        assert!(excess(&bounds, "lean", &observed(lean)) < 1e-3);
    }
}

#[test]
#[ignore = "thousands of solutions, to 1.5 s"]
fn thousands_of_solutions_of_the_double_pendulum_are_held() {
    let (bounds, failure) = certify(two_bobs(1.5, "step: 2e-3"));
    assert_eq!(failure, None);
    let values = |p: f64| two_bobs_by_hand(p, &bounds.times).iter().map(|y| y[0].sin() + y[1].sin()).collect();
    let solutions: Vec<Vec<f64>> = box_of(5000).map(|xi| values(1.0 + 5e-3 * xi)).collect();
    held("double pendulum to 1.5 s", solutions.len(), excess(&bounds, "x", &solutions), 1e-5);
}

/// Three parameters: the first angle, its rate and gravity.
fn of_three_parameters(samples: usize, duration: f64) {
    let (angle, gravity, rate) = (5e-3, 0.05, 0.01);
    let (bounds, failure) = certify(read(&TWO_BOBS_OF_THREE.replace("DURATION", &duration.to_string())));
    assert_eq!(failure, None);
    let corner = |index: usize| [1, 2, 4].map(|bit| if index & bit == 0 { -1.0 } else { 1.0 });
    // The corners, then a lattice of irrational slopes.
    let inside = |index: usize| {
        [0.618_033_988_7, 0.414_213_562_4, 0.732_050_807_6].map(|slope| 2.0 * (index as f64 * slope).fract() - 1.0)
    };
    let points = (0..8).map(corner).chain((0..samples).map(inside));
    let at = |[a, b, c]: [f64; 3]| two_bobs_under(1.0 + angle * a, 9.81 + gravity * b, 0.43 + rate * c, &bounds.times);
    let solutions: Vec<_> = points.map(at).collect();
    let x: Vec<Vec<f64>> =
        solutions.iter().map(|rows| rows.iter().map(|y| y[0].sin() + y[1].sin()).collect()).collect();
    held(&format!("double pendulum to {duration} s, three parameters"), x.len(), excess(&bounds, "x", &x), 1e-4);
}

const TWO_BOBS_OF_THREE: &str = "
parameters: { p: { value: 1, tolerance: 0.5% }, g: { value: 9.81, tolerance: 0.05 }, r: { value: 0.43, tolerance: 0.01 } }
bodies:
  first: { mass: 1, inertia: 0, points: { top: [0, 1], bob: [0, 0] } }
  second: { mass: 1, inertia: 0, points: { top: [0, 1] } }
joints:
  upper: { revolute: [ground, first.top] }
  lower: { revolute: [first.bob, second.top] }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial:
  first.angle: 0.75*pi*p
  first.angular_velocity: r
  second.angle: -0.55*pi
  second.angular_velocity: 0.67
outputs: { x: second.x }
simulation: { duration: DURATION, step: 2e-3, output_step: 0.1 }
";

#[test]
fn solutions_over_three_parameters_are_held() {
    of_three_parameters(200, 0.2);
}

#[test]
#[ignore = "thousands of solutions over three parameters"]
fn thousands_of_solutions_over_three_parameters_are_held() {
    of_three_parameters(20_000, 0.5);
}

/// θ and its rate of the slider crank of Wu, Luo and Zhang in its minimal coordinate.
fn slider_crank_by_hand(l1: f64, times: &[f64]) -> Vec<[f64; 2]> {
    let (l2, m1, m2, m3, c, k, torque) = (0.56, 0.37, 0.77, 0.45, 1.0, 5.0, -0.5);
    let equation = |_: f64, y: &[f64], d: &mut [f64]| {
        let (s, co) = y[0].sin_cos();
        let sp = -l1 * s / l2;
        let cp = (1.0 - sp * sp).sqrt();
        let fp = -l1 * co / (l2 * cp);
        let fpp = l1 * s / (l2 * cp) + fp * fp * sp / cp;
        let (xp, xpp) = (-l1 * s - l2 * sp * fp, -l1 * co - l2 * cp * fp * fp - l2 * sp * fpp);
        let (cx, cy) = (-l1 * s - 0.5 * l2 * sp * fp, l1 * co + 0.5 * l2 * cp * fp);
        let cxp = -l1 * co - 0.5 * l2 * (cp * fp * fp + sp * fpp);
        let cyp = -l1 * s + 0.5 * l2 * (-sp * fp * fp + cp * fpp);
        let of_rods = m1 * l1 * l1 / 3.0 + m2 * l2 * l2 / 12.0 * fp * fp;
        let inertia = of_rods + m2 * (cx * cx + cy * cy) + m3 * xp * xp;
        let change = 2.0 * (m2 * (cx * cxp + cy * cyp) + m2 * l2 * l2 / 12.0 * fp * fpp + m3 * xp * xpp);
        let stretch = l1 * co + l2 * cp - l1 - l2;
        d[0] = y[1];
        d[1] = (torque - k * stretch * xp - c * xp * xp * y[1] - 0.5 * change * y[1] * y[1]) / inertia;
    };
    solve(equation, &[0.0, 0.0], times, 1e-12, 1e-2)
}

#[test]
fn solutions_of_the_slider_crank_are_held() {
    let (bounds, failure) = certify(model("slider_crank_one").duration(0.4).rows_every(0.04));
    assert_eq!(failure, None);
    let solutions: Vec<_> = box_of(200).map(|xi| (0.15 * (1.0 + 0.01 * xi), xi)).collect();
    let solutions: Vec<_> =
        solutions.into_iter().map(|(l1, _)| (l1, slider_crank_by_hand(l1, &bounds.times))).collect();
    let x3 = |l1: f64, y: &[f64]| l1 * y[0].cos() + (0.56_f64.powi(2) - (l1 * y[0].sin()).powi(2)).sqrt();
    let positions: Vec<Vec<f64>> =
        solutions.iter().map(|(l1, rows)| rows.iter().map(|y| x3(*l1, y)).collect()).collect();
    let angles: Vec<Vec<f64>> = solutions.iter().map(|(_, rows)| rows.iter().map(|y| y[0]).collect()).collect();
    held("slider crank to 0.4 s", positions.len(), excess(&bounds, "x3", &positions), 1e-6);
    assert!(excess(&bounds, "crank_angle", &angles) < 1e-5);
}

/// All of l1 ± 1 % over 2 s: tens of thousands of samples lie within, and the bounds are hardly wider. `MBINT_SAMPLES`
/// is another number of samples.
#[test]
#[ignore = "a minute: a proof over the whole box, and 20 000 solutions"]
fn the_whole_slider_crank_is_held() {
    let (bounds, failure) = certify(model("slider_crank_one"));
    assert_eq!(failure, None);
    let x3 = |l1: f64, y: &[f64]| l1 * y[0].cos() + (0.56_f64.powi(2) - (l1 * y[0].sin()).powi(2)).sqrt();
    let solution = |xi: f64| {
        let l1 = 0.15 * (1.0 + 0.01 * xi);
        slider_crank_by_hand(l1, &bounds.times).iter().map(|y| x3(l1, y)).collect()
    };
    let count = std::env::var("MBINT_SAMPLES").map_or(20_000, |count| count.parse().unwrap());
    let positions: Vec<Vec<f64>> = box_of(count).collect::<Vec<f64>>().into_par_iter().map(solution).collect();
    let excess = excess(&bounds, "x3", &positions);
    println!("x3 is wider than its samples by at most {excess:.2e} m");
    held("slider crank to 2 s", count, excess, 1e-5);
    let certificate =
        Certificate { model: bounds.outputs[0].name.clone(), files: Vec::new(), systems: bounds.certified };
    println!("{:?}", check(&certificate).unwrap());
}

/// The pendulum of the library of benchmarks comes back after its period, 4 K(sin² 45°) √(l/g).
#[test]
fn the_pendulum_comes_back_after_its_period() {
    let period = 2.367_841_947_576_237_4;
    let description = model("pendulum").uncertain("length", 0.0).duration(period).rows_every(period / 4.0);
    let (bounds, failure) = certify(description);
    assert_eq!(failure, None);
    for (name, rows) in [("x", [-1.0, 0.0, 1.0, 0.0, -1.0]), ("y", [0.0, -1.0, 0.0, -1.0, 0.0])] {
        let certified = band(output(&bounds, name), Method::Certified);
        for (row, exact) in rows.into_iter().enumerate() {
            let (lower, upper) = (certified.lower[row], certified.upper[row]);
            // The rows' times are known to 1e-15 s at a speed of 4.4 m/s.
            assert!(lower - 1e-14 <= exact && exact <= upper + 1e-14, "{name} {row}: [{lower}, {upper}]");
            assert!(upper - lower < 1e-8, "{name} {row}: [{lower}, {upper}]");
        }
    }
}

/// Centre of mass of the heavy top (m): Euler's equations about its foot, and rates of the orientation's parameters.
fn heavy_top_by_hand(axial: f64, spin: f64, times: &[f64]) -> Vec<Vec<f64>> {
    let (mass, arm, g) = (15.0, 1.0, 9.81);
    let inertia = [0.234375 + mass * arm * arm, axial, 0.234375 + mass * arm * arm];
    let equation = |_: f64, y: &[f64], d: &mut [f64]| {
        let ([p, a, b, c], w) = ([y[0], y[1], y[2], y[3]], [y[4], y[5], y[6]]);
        // The vertical in the top's frame: the last row of its rotation matrix.
        let up = [2.0 * (a * c - p * b), 2.0 * (b * c + p * a), p * p - a * a - b * b + c * c];
        // (0, arm, 0) × (−m g up)
        let torque = [-mass * g * arm * up[2], 0.0, mass * g * arm * up[0]];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            d[4 + i] = (torque[i] + (inertia[j] - inertia[k]) * w[j] * w[k]) / inertia[i];
        }
        d[0] = -0.5 * (a * w[0] + b * w[1] + c * w[2]);
        d[1] = 0.5 * (p * w[0] + b * w[2] - c * w[1]);
        d[2] = 0.5 * (p * w[1] + c * w[0] - a * w[2]);
        d[3] = 0.5 * (p * w[2] + a * w[1] - b * w[0]);
    };
    let rows = solve(equation, &[1.0, 0.0, 0.0, 0.0, 0.0, spin, -4.61538], times, 1e-14, 1e-3);
    let centre = |y: &[f64; 7]| {
        let [p, a, b, c] = [y[0], y[1], y[2], y[3]];
        vec![2.0 * (a * b - p * c), p * p - a * a + b * b - c * c, 2.0 * (b * c + p * a)]
    };
    rows.iter().map(centre).collect()
}

/// All parameters of the orientation are given at the start; they fulfil the normalisation but for their rounding.
#[test]
fn solutions_of_the_heavy_top_are_held() {
    let (bounds, failure) = certify(model("heavy_top").duration(0.02).rows_every(0.005));
    assert_eq!(failure, None);
    let boxes = box_of(12).flat_map(|a| box_of(12).map(move |b| (a, b)));
    let solutions: Vec<_> = boxes
        .map(|(a, b)| heavy_top_by_hand(0.46875 * (1.0 + 5e-3 * a), 150.0 * (1.0 + 5e-3 * b), &bounds.times))
        .collect();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let observed: Vec<Vec<f64>> = solutions.iter().map(|rows| rows.iter().map(|row| row[axis]).collect()).collect();
        assert!(excess(&bounds, name, &observed) < 1e-8, "{name}");
    }
}

/// Friction that turns smoothly about rest does so within 17 µs: cells are as short as that at first.
#[test]
fn solutions_of_a_stiff_start_are_held() {
    let (bounds, failure) = certify(read(
        "
parameters: { f: { value: 400 N, tolerance: 1% } }
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  push: { force: { on: mass, value: [f, 0] } }
  drag: { force: { on: mass, value: [\"-(100 N)*mass.vx/sqrt(mass.vx^2 + (0.01 m/s)^2)\", 0] } }
initial: { mass.x: 0, mass.vx: 0 }
outputs: { v: mass.vx }
simulation: { duration: 0.01, step: 1e-4, output_step: 1e-3 }
",
    ));
    assert_eq!(failure, None);
    let motion = |xi: f64| {
        let f = 400.0 * (1.0 + 0.01 * xi);
        let rate = |_: f64, v: &[f64], d: &mut [f64]| d[0] = (f - 100.0 * v[0] / v[0].hypot(0.01)) / 0.5;
        solve(rate, &[0.0], &bounds.times, 1e-14, 1e-6).into_iter().map(|row| row[0]).collect()
    };
    let observed: Vec<Vec<f64>> = box_of(20).map(motion).collect();
    assert!(excess(&bounds, "v", &observed) < 1e-6);
}

#[test]
#[ignore = "2 s"]
fn rows_beyond_the_end_are_unknown_and_reported() {
    // A ball falls into a centre that attracts it with k/x: the equations end there, at √(π/2) s = 1.253 s for k = 1.
    let (bounds, failure) = certify(read(
        "
parameters: { k: { value: 1, tolerance: 1% } }
bodies: { ball: { mass: 1, coordinates: [x] } }
effects: { pull: { force: { on: ball, value: [-k/(ball.x/(1 m))*(1 N), 0] } } }
initial: { ball.x: 1 }
outputs: { x: ball.x }
simulation: { duration: 1.4, step: 1e-3, output_step: 0.1 }
",
    ));
    let failure = failure.expect("the motion ends at 1.25 s");
    assert!(failure.contains("certified bounds are unknown from there on"), "{failure}");
    assert!(failure.contains("smaller pieces come no further, as where equations are singular"), "{failure}");
    let certified = band(output(&bounds, "x"), Method::Certified);
    assert_eq!(certified.lower.len(), bounds.times.len());
    assert!(certified.lower[0] <= 1.0 && certified.upper[0] >= 1.0 && certified.upper[12].is_finite());
    assert!(certified.lower.last().unwrap().is_nan() && certified.upper.last().unwrap().is_nan());
}

/// The derivative of a jump is zero, and says nothing about the distance of two motions.
#[test]
fn jumps_of_positions_or_velocities_are_refused() {
    let (_, failure) = certify(read(
        "
parameters: { k: { value: 1, tolerance: 1% } }
bodies: { ball: { mass: 1, coordinates: [x] } }
effects: { push: { force: { on: ball, value: [-k*floor(ball.x/(1 m))*(1 N), 0] } } }
initial: { ball.x: 0.5, ball.vx: 1 }
outputs: { x: ball.x }
simulation: { duration: 1, step: 0.01 }
",
    ));
    let failure = failure.expect("a jump has no proof");
    assert!(failure.contains("`floor` of positions or velocities"), "{failure}");
}
