//! Linkages whose positions are trigonometry: the loops must close as the closed forms say, to Newton's tolerance, and
//! the velocities follow to second order.

use crate::common::measured::Case;
use crate::common::{curve, distance_from, largest, model, nominal, order, read, reference, row};
use std::f64::consts::{PI, TAU};

/// Newton's tolerance (1e-11 of the model's size) times the slopes of the closed forms.
const CLOSED: f64 = 1e-10;

/// Rocker angle of the four-bar `four_bar.yaml`, from Freudenstein's equation, in the branch above the base.
fn freudenstein(crank: f64) -> f64 {
    let (base, a, b, c) = (0.3, 0.1, 0.26, 0.22);
    let (k1, k2) = (base / a, base / c);
    let k3 = (a * a - b * b + c * c + base * base) / (2.0 * a * c);
    // K1 cos ψ − K2 cos φ + K3 = cos(φ − ψ), as A sin ψ + B cos ψ = C.
    let (sine, cosine, right) = (crank.sin(), crank.cos() - k1, k3 - k2 * crank.cos());
    let middle = sine.atan2(cosine);
    let half = (right / sine.hypot(cosine)).acos();
    let [one, other] = [wrapped(middle + half), wrapped(middle - half)];
    if (0.0..PI).contains(&one) { one } else { other }
}

#[test]
fn the_rocker_obeys_freudenstein() {
    let description = model("four_bar").observing(&["rocker.angle", "crank.angle", "rocker.angular_velocity"]);
    let speeds = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&description.clone().step(h));
        let rocker = curve(&bounds, "rocker.angle");
        let error = largest(bounds.times.iter().zip(rocker).map(|(&t, &angle)| wrapped(angle - freudenstein(TAU * t))));
        let case =
            Case::new("textbook", &format!("four-bar, rocker's angle, h = {h:e} s")).source("Freudenstein's equation");
        case.at_most("largest error", error, CLOSED).note();
        assert!(distance_from(&bounds.times, curve(&bounds, "crank.angle"), |t| TAU * t) < CLOSED);
        let slope = |t: f64| wrapped(freudenstein(TAU * (t + 1e-5)) - freudenstein(TAU * (t - 1e-5))) / 2e-5;
        distance_from(&bounds.times, curve(&bounds, "rocker.angular_velocity"), slope)
    });
    println!("rocker speed: errors {speeds:?}");
    let case = Case::new("textbook", "four-bar, rocker's speed").source("Freudenstein's equation, differences");
    case.order("order", order(speeds[0], speeds[1]), 2.0).figure("largest error", speeds[1]).note();
}

/// An angle in [−π, π).
fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// Lever angle and ram position of `quick_return.yaml`.
fn quick_return(crank: f64) -> (f64, f64) {
    let (r, offset, lever, link, height): (f64, f64, f64, f64, f64) = (0.1, 0.25, 0.5, 0.2, 0.23);
    let angle = (offset + r * crank.sin()).atan2(r * crank.cos());
    let (x, y) = (lever * angle.cos(), lever * angle.sin() - offset);
    (angle, x + (link * link - (height - y).powi(2)).sqrt())
}

#[test]
fn the_quick_return_follows_its_geometry() {
    let bounds = nominal(&model("quick_return").observing(&["lever.angle", "ram.x"]));
    let lever = distance_from(&bounds.times, curve(&bounds, "lever.angle"), |t| quick_return(TAU * t).0);
    let ram = distance_from(&bounds.times, curve(&bounds, "ram.x"), |t| quick_return(TAU * t).1);
    let case = Case::new("textbook", "quick return, lever and ram").source("triangles of the linkage");
    case.at_most("largest error", lever.max(ram), CLOSED).note();
}

#[test]
fn the_quick_return_has_its_time_ratio() {
    // The lever turns back where the crank stands square to it.
    let asin = (0.1_f64 / 0.25).asin();
    let expected = (PI + 2.0 * asin) / (PI - 2.0 * asin);
    let bounds = nominal(&model("quick_return").observing(&["lever.angular_velocity"]).rows_every(1e-3));
    let speed = &bounds.outputs[0].nominal;
    let turns: Vec<f64> = (1..speed.len())
        .filter(|&row| speed[row - 1] * speed[row] < 0.0)
        .map(|row| bounds.times[row] - 1e-3 * speed[row] / (speed[row] - speed[row - 1]))
        .collect();
    let (first, second) = (turns[1] - turns[0], turns[2] - turns[1]);
    let ratio = first.max(second) / first.min(second);
    println!("ratio {ratio}, expected {expected}");
    // The zeros are found by linear interpolation, and speeds are good to O(h²), about 1e-5 of their size.
    let case = Case::new("textbook", "quick return, time ratio").source("(π + 2 asin r/e) / (π − 2 asin r/e)");
    case.at_most("largest error", (ratio - expected).abs(), 1e-4).note();
    assert!((first + second - 1.0).abs() < 1e-4, "a turn takes {} s", first + second);
}

/// t, x, y of the first bar's end (Taylor series, 30 digits).
pub fn two_loops_reference() -> Vec<Vec<f64>> {
    reference("iftomm/four_bar_n2.csv")
}

/// Problem A02 of the IFToMM library: where all bars lie on a line the mechanism gains degrees of freedom for a moment.
pub fn two_loops() -> String {
    let bar = |name: &str, low: &str, high: &str| {
        format!("  {name}: {{ mass: 1, inertia: 1/12, points: {{ {low}: [-0.5, 0], {high}: [0.5, 0] }} }}\n")
    };
    let mut text = "bodies:\n  ground: { points: { P0: [0, 0], P1: [1, 0], P2: [2, 0] } }\n".to_owned();
    for name in ["bar0", "bar1", "bar2"] {
        text += &bar(name, "foot", "end");
    }
    for name in ["coupler0", "coupler1"] {
        text += &bar(name, "left", "right");
    }
    text += "joints:\n";
    for index in 0..3 {
        text += &format!("  foot{index}: {{ revolute: [ground.P{index}, bar{index}.foot] }}\n");
    }
    for index in 0..2 {
        text += &format!("  left{index}: {{ revolute: [bar{index}.end, coupler{index}.left] }}\n");
        text += &format!("  right{index}: {{ revolute: [coupler{index}.right, bar{}.end] }}\n", index + 1);
    }
    text += "
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bar0.angle: 90 deg, bar0.angular_velocity: -1 }
guess: { bar1.angle: 90 deg, bar2.angle: 90 deg, coupler0.angle: 0, coupler1.angle: 0 }
outputs: { x: bar0.end.x, y: bar0.end.y, energy: energy }
simulation: { duration: 10, step: 1e-3, output_step: 0.01 }
";

    text
}

#[test]
fn two_loops_pass_their_singular_position() {
    let rows = two_loops_reference();
    let errors = [5e-4, 2.5e-4].map(|h| {
        let bounds = nominal(&read(&two_loops()).step(h));
        largest(rows.iter().flat_map(|line| {
            let row = row(&bounds, line[0]);
            [bounds.outputs[0].nominal[row] - line[1], bounds.outputs[1].nominal[row] - line[2]]
        }))
    });
    println!("errors {errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    // Measured: 2.9e-4, 6.7e-5, 1.6e-5 and 3.9e-6 m for h = 1e-3 and its halves.
    assert!(errors[0] < 1e-4, "{errors:?}");
}
