//! Certified bounds of laws beyond arithmetic: exponentials, logarithms, powers, tables, contacts that are not reached,
//! and forces that jump. Solutions are by hand, or by Dormand and Prince's method of equations by hand.

use mbint::certificate::{Certificate, check};
use mbint::results::{Bounds, Method};

use super::certify_motion::{box_of, certify, excess};
use crate::common::Subject;
use crate::common::dop853::solve;
use crate::common::*;

/// Rounding of closed forms.
const ROUNDING: f64 = 1e-15;

/// A mass of 1 kg that a force in N, a formula, moves along x.
fn pushed(force: &str, more: &str, duration: f64) -> Bounds {
    let (bounds, failure) = certify(pushed_model(force, more, duration));
    assert_eq!(failure, None);
    // The checker has derivatives of its own.
    let systems = bounds.certified.clone();
    check(&Certificate { model: "pushed".to_owned(), files: Vec::new(), systems }).unwrap();
    bounds
}

fn pushed_model(force: &str, more: &str, duration: f64) -> Subject {
    read(&format!(
        "
parameters: {{ k: {{ value: 3, tolerance: 1% }} }}
{more}
bodies: {{ mass: {{ mass: 1, coordinates: [x] }} }}
effects: {{ push: {{ force: {{ on: mass, value: [\"{force}\", 0] }} }} }}
initial: {{ mass.x: 0.5, mass.vx: 0.2 }}
outputs: {{ x: mass.x, v: mass.vx, a: mass.ax }}
simulation: {{ duration: {duration}, step: 0.01, output_step: 0.05 }}
"
    ))
}

/// Asserts that the bands hold the motions under a force of k, t, x and v, with an excess of less than this.
fn hold(bounds: &Bounds, force: impl Fn(f64, f64, &[f64]) -> f64, most: f64) {
    let motion = |xi: f64| {
        let k = 3.0 * (1.0 + 0.01 * xi);
        let rates = |t: f64, y: &[f64], d: &mut [f64]| d.copy_from_slice(&[y[1], force(k, t, y)]);
        let rows = solve(rates, &[0.5, 0.2], &bounds.times, 1e-14, 1e-2);
        let times = bounds.times.iter();
        let accelerations: Vec<f64> = rows.iter().zip(times).map(|(y, &t)| force(k, t, y)).collect();
        [rows.iter().map(|y| y[0]).collect(), rows.iter().map(|y| y[1]).collect(), accelerations]
    };
    let motions: Vec<[Vec<f64>; 3]> = box_of(40).map(motion).collect();
    for (index, name) in ["x", "v", "a"].into_iter().enumerate() {
        let samples: Vec<Vec<f64>> = motions.iter().map(|own| own[index].clone()).collect();
        let wider = excess(bounds, name, &samples);
        // Between samples an extreme may be higher.
        assert!(wider < most, "{name}: {wider:e}");
    }
}

#[test]
fn motions_under_smooth_functions_are_held() {
    let force = "-k*tanh(mass.x/(0.25 m)) - 0.2*exp(-mass.x/(1 m))*mass.vx - 0.1*atan(mass.vx/(1 m/s)) \
                 + log(2 + mass.x/(1 m)) + 0.3*(1.5 + mass.x/(1 m))^1.5 - 0.2*asin(mass.x/(3 m)) \
                 + 0.1*acos(mass.x/(2 m)) + 0.1*atan2(mass.vx/(1 m/s), 2)";
    let by_hand = |k: f64, _: f64, y: &[f64]| {
        let [x, v] = [y[0], y[1]];
        -k * (x / 0.25).tanh() - 0.2 * (-x).exp() * v - 0.1 * v.atan() + (2.0 + x).ln() + 0.3 * (1.5 + x).powf(1.5)
            - 0.2 * (x / 3.0).asin()
            + 0.1 * (x / 2.0).acos()
            + 0.1 * v.atan2(2.0)
    };
    hold(&pushed(force, "", 1.0), by_hand, 2e-5);
}

/// The natural spline through points, by its second derivatives (de Boor, ch. 4), by elimination of a full matrix.
fn natural_spline(points: &[(f64, f64)]) -> impl Fn(f64) -> f64 + use<'_> {
    let n = points.len();
    let h: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    let mut matrix = nalgebra::DMatrix::<f64>::identity(n, n);
    let mut right = nalgebra::DVector::<f64>::zeros(n);
    for i in 1..n - 1 {
        matrix[(i, i - 1)] = h[i - 1];
        matrix[(i, i)] = 2.0 * (h[i - 1] + h[i]);
        matrix[(i, i + 1)] = h[i];
        let slope = |i: usize| (points[i + 1].1 - points[i].1) / h[i];
        right[i] = 6.0 * (slope(i) - slope(i - 1));
    }
    let second = matrix.lu().solve(&right).unwrap();
    move |x: f64| {
        let i = points.iter().rposition(|point| point.0 <= x).unwrap_or(0).min(n - 2);
        let (a, b) = (points[i + 1].0 - x, x - points[i].0);
        (second[i] * a.powi(3) + second[i + 1] * b.powi(3)) / (6.0 * h[i])
            + (points[i].1 / h[i] - second[i] * h[i] / 6.0) * a
            + (points[i + 1].1 / h[i] - second[i + 1] * h[i] / 6.0) * b
    }
}

const SPRING: [(f64, f64); 6] = [(-1.0, -2.0), (-0.4, -0.9), (0.0, 0.0), (0.3, 0.5), (0.8, 1.9), (1.2, 3.0)];
const DRIVE: [(f64, f64); 4] = [(0.0, 0.0), (0.5, 1.0), (1.1, -0.5), (2.0, 0.3)];

fn table(name: &str, points: &[(f64, f64)], more: &str) -> String {
    let points: Vec<String> = points.iter().map(|(x, y)| format!("[{x}, {y}]")).collect();
    format!("  {name}: {{ points: [{}]{more} }}\n", points.join(", "))
}

/// The mass passes two knots, at instants that depend on the parameter.
#[test]
fn motions_through_the_knots_of_a_table_are_held() {
    let tables = format!("tables:\n{}", table("spring", &SPRING, ""));
    let spring = natural_spline(&SPRING);
    hold(&pushed("-k*spring(mass.x)", &tables, 1.5), |k, _, y| -k * spring(y[0]), 2e-5);
}

#[test]
fn motions_under_a_table_of_time_are_held() {
    let tables = format!("tables:\n{}", table("drive", &DRIVE, ""));
    let drive = natural_spline(&DRIVE);
    hold(&pushed("-k*mass.x/(1 m) + drive(t)", &tables, 1.5), |k, t, y| -k * y[0] + drive(t), 2e-5);
}

/// Straight lines bend at their knots, none of which but the first and the last is the end of a cell.
#[test]
fn motions_under_straight_lines_of_time_are_held() {
    let points = [(0.0, 0.0), (0.3, 1.0), (0.7, -0.5), (1.0, 0.3)];
    let tables = format!("tables:\n{}", table("drive", &points, ", interpolation: linear"));
    let bounds = pushed("k*drive(t)", &tables, 1.0);
    // x = x₀ + v₀ t + k ∬ drive, piece by piece: with slope s from (t₀, y₀) the integrals have closed forms.
    let integrals = |t: f64| {
        let (mut speed, mut way) = (0.0, 0.0);
        for pair in points.windows(2).filter(|pair| pair[0].0 < t) {
            let (d, y, s) =
                (t.min(pair[1].0) - pair[0].0, pair[0].1, (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0));
            way += speed * d + y * d * d / 2.0 + s * d.powi(3) / 6.0;
            speed += y * d + s * d * d / 2.0;
        }
        [way, speed]
    };
    let of = |at: fn(f64, [f64; 2], f64) -> f64| -> Vec<Vec<f64>> {
        let row = |k: f64| bounds.times.iter().map(|&t| at(t, integrals(t), k)).collect();
        [2.97, 3.03].map(row).to_vec()
    };
    assert!(excess(&bounds, "x", &of(|t, [way, _], k| 0.5 + 0.2 * t + k * way)) < 1e-6);
    assert!(excess(&bounds, "v", &of(|_, [_, speed], k| 0.2 + k * speed)) < 1e-6);
}

/// A smooth law of contact is enclosed while the whole box is away from it; the band ends where a part of the box may
/// touch.
#[test]
fn a_contact_is_enclosed_until_it_is_touched() {
    // x = 0.5 + 0.2 t − k t²/2 reaches 0.1 at t = 0.587 s for k = 3, and by 3 ms earlier or later over the box.
    let model = "
parameters: { k: { value: 3, tolerance: 1% } }
bodies: { mass: { mass: 1, coordinates: [x] } }
effects:
  push: { force: { on: mass, value: [\"-k*(1 N)\", 0] } }
  wall: { force: { on: mass, value: [\"1e4*max(0.1 - mass.x/(1 m), 0)^1.5\", 0] } }
initial: { mass.x: 0.5, mass.vx: 0.2 }
outputs: { x: mass.x }
simulation: { duration: 1, step: 0.01, output_step: 0.05 }
";
    let (bounds, failure) = certify(read(model));
    assert!(failure.is_some_and(|told| told.contains("certified bounds are unknown from there on")));
    let x = |k: f64| bounds.times.iter().map(|t| 0.5 + 0.2 * t - k * t * t / 2.0).collect::<Vec<f64>>();
    let free = bounds.times.iter().take_while(|&&t| t < 0.58).count();
    let certified = band(output(&bounds, "x"), Method::Certified);
    let [first, last] = [2.97, 3.03].map(x);
    for row in 0..free {
        assert!(certified.lower[row] <= last[row] + ROUNDING && first[row] <= certified.upper[row] + ROUNDING);
        assert!(certified.upper[row] - certified.lower[row] < first[row] - last[row] + 1e-9, "row {row}");
    }
    assert!(certified.upper[free + 1..].iter().all(|value| value.is_nan()));
}

/// A force that jumps has a derivative of zero on either side, which says nothing about motions that are on both.
#[test]
fn a_force_that_jumps_ends_the_band() {
    let (bounds, failure) = certify(pushed_model("if(mass.x > 0.6, -k, k)", "", 1.0));
    assert!(failure.is_some());
    // x = 0.5 + 0.2 t + k t²/2 is 0.6 at t = 0.200 s for k = 3.
    let certified = band(output(&bounds, "x"), Method::Certified);
    assert!(certified.upper[3].is_finite() && certified.upper[5..].iter().all(|value| value.is_nan()));
}

#[test]
fn a_table_of_positions_that_jumps_is_refused() {
    let text = "
parameters: { k: { value: 3, tolerance: 1% } }
tables: { path: { points: [[0, 0], [0.5, 1], [1.1, -0.5]], interpolation: linear } }
bodies:
  a: { mass: 1, coordinates: [x] }
  b: { mass: k, coordinates: [x] }
joints: { guide: { equation: \"b.x = path(a.x)\" } }
initial: { a.x: 0.4, a.vx: 0.1 }
outputs: { x: b.x }
simulation: { duration: 0.1, step: 0.01 }
";
    let (_, failure) = certify(read(text));
    let failure = failure.expect("a bend of a constraint is a jump of its forces");
    assert!(failure.contains("a table, or a derivative of one, of positions"), "{failure}");
}
