//! Motors whose speed follows a state or a position, against closed forms and motors that are prescribed.

use mbint::Formulation;
use mbint::results::{Bounds, Method};

use crate::common::power::{assert_balance, pair, spatial_pair};
use crate::common::{band, curve, distance, distance_from, nominal, output, read, refused, run};

/// How a motion is integrated, by how much positions and speeds may be off, and by how much forces.
const WAYS: [(&str, f64, f64); 4] = [
    ("step: 1e-3", 1e-5, 2e-2),
    ("step: 2e-3, extrapolation: 4", 1e-10, 1e-7),
    ("tolerance: 1e-8", 1e-6, 1e-2),
    ("scheme: explicit, tolerance: 1e-10", 1e-8, 1e-7),
];

/// A pendulum of 2 kg, 0.3 m below its hinge, whose speed is 4 rad/s behind a lag of 0.2 s.
fn pendulum(simulation: &str) -> String {
    format!(
        "
parameters: {{ lag: {{ value: 0.2, unit: s, tolerance: 10% }} }}
bodies: {{ bar: {{ mass: 2, inertia: 0.05, points: {{ A: [-0.3, 0] }} }} }}
joints:
  hinge: {{ revolute: [ground, bar.A] }}
  drive: {{ motor: {{ on: hinge, speed: command }} }}
states: {{ command: {{ rate: (4 rad/s - command)/lag, initial: 0 rad/s }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ hinge.angle: 0.5 }}
outputs: {{ angle: hinge.angle, rate: hinge.angular_velocity, command: command, torque: drive.torque }}
simulation: {{ duration: 1, output_step: 0.1, {simulation} }}
bounds: {{ chebyshev: {{ order: 6 }}, taylor: {{ order: 6 }}, scan: {{ points: 5 }} }}
"
    )
}

fn angle(lag: f64, t: f64) -> f64 {
    0.5 + 4.0 * (t - lag * (1.0 - (-t / lag).exp()))
}

fn rate(lag: f64, t: f64) -> f64 {
    4.0 * (1.0 - (-t / lag).exp())
}

fn torque(lag: f64, t: f64) -> f64 {
    (0.05 + 2.0 * 0.09) * 4.0 / lag * (-t / lag).exp() + 2.0 * 9.81 * 0.3 * angle(lag, t).cos()
}

fn off(bounds: &Bounds, name: &str, wanted: impl Fn(f64) -> f64) -> f64 {
    distance_from(&bounds.times, curve(bounds, name), wanted)
}

/// The angle is the integral of the command, the torque that of inverse dynamics, and the command feels nothing of it.
#[test]
fn a_pendulum_follows_a_speed_behind_a_lag() {
    for formulation in [Formulation::Absolute, Formulation::Joint] {
        for (simulation, of_motion, of_forces) in WAYS {
            let description = read(&pendulum(simulation)).formulation(formulation);
            let bounds = nominal(&description);
            for (name, off, allowed) in [
                ("angle", off(&bounds, "angle", |t| angle(0.2, t)), of_motion),
                ("rate", off(&bounds, "rate", |t| rate(0.2, t)), of_motion),
                ("command", off(&bounds, "command", |t| rate(0.2, t)), of_motion),
                ("torque", off(&bounds, "torque", |t| torque(0.2, t)), of_forces),
            ] {
                assert!(off < allowed, "{formulation:?} {simulation}: {name} is off by {off:e}");
            }
            let between = distance(curve(&bounds, "rate"), curve(&bounds, "command"));
            assert!(between < 1e-9, "{formulation:?} {simulation}: {between:e} between speed and command");
        }
    }
}

#[test]
fn bounds_over_the_lag_match_the_closed_form() {
    for simulation in ["step: 2e-3, extrapolation: 4", "scheme: explicit, tolerance: 1e-10"] {
        let bounds = run(&read(&pendulum(simulation)));
        for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
            for (name, of) in [("angle", angle as fn(f64, f64) -> f64), ("rate", rate), ("torque", torque)] {
                let band = band(output(&bounds, name), method);
                for (row, &t) in bounds.times.iter().enumerate() {
                    let all: Vec<f64> = (0..=400).map(|part| of(0.18 + 1e-4 * f64::from(part), t)).collect();
                    let [low, high] =
                        [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| all.iter().copied().reduce(of).unwrap());
                    let allowed = band.error.total[row] + 1e-6;
                    let off = (band.lower[row] - low).abs().max((band.upper[row] - high).abs());
                    assert!(off < allowed, "{simulation} {method:?} {name} at {t}: {off:e} {allowed:e}");
                }
            }
        }
    }
}

/// A speed by the remaining way: θ̇ = 3 (1.2 − θ), in the plane and in space, and one by a state that depends on the
/// position.
#[test]
fn a_speed_may_follow_positions() {
    for (space, formulation) in [("", "absolute"), ("", "joint"), (", z: 0", "absolute")] {
        let ground = if space.is_empty() { "[0, 0]" } else { "[0, 0, 0]" };
        let text = format!(
            "
bodies:
  ground: {{ points: {{ O: {ground} }} }}
  arm: {{ mass: 2, inertia: 0.05 }}
joints:
  hinge: {{ revolute: [ground.O, arm] }}
  drive: {{ motor: {{ on: hinge, speed: 3*(1.2 - hinge.angle) }} }}
initial: {{ hinge.angle: 0.2 }}
outputs: {{ angle: hinge.angle, torque: drive.torque }}
simulation: {{ duration: 1, output_step: 0.1, step: 2e-3, extrapolation: 4, formulation: {formulation} }}
"
        );
        let bounds = nominal(&read(&text));
        let angle = off(&bounds, "angle", |t| 1.2 - (-3.0 * t).exp());
        let torque = off(&bounds, "torque", |t| -0.05 * 9.0 * (-3.0 * t).exp());
        assert!(angle < 1e-9 && torque < 1e-8, "{formulation}: {angle:e} {torque:e}");
    }
    // ṡ = y, ẏ = 20 (0.4 − s) − 4 y: s = 0.4 − e^{−2t} (0.4 cos 4t + 0.2 sin 4t).
    let text = "
bodies: { slide: { mass: 3, inertia: 1 } }
joints:
  guide: { prismatic: { between: [ground, slide], axis: [1, 0] } }
  drive: { motor: { on: guide, speed: y } }
states: { y: { rate: 20*(0.4 m - guide.displacement)/(1 s^2) - 4*y/(1 s), initial: 0 m/s } }
initial: { guide.displacement: 0 }
outputs: { s: guide.displacement, force: drive.force }
simulation: { duration: 1, output_step: 0.1, step: 2e-3, extrapolation: 4 }
";
    let bounds = nominal(&read(text));
    let s = off(&bounds, "s", |t| 0.4 - (-2.0 * t).exp() * (0.4 * (4.0 * t).cos() + 0.2 * (4.0 * t).sin()));
    // s̈ = e^{−2t} (8 cos 4t − 4 sin 4t).
    let force =
        off(&bounds, "force", |t| 3.0 * (-2.0 * t).exp() * (8.0 * (4.0 * t).cos() - 4.0 * (4.0 * t).sin()).abs());
    assert!(s < 1e-9 && force < 1e-7, "{s:e} {force:e}");
}

fn slider_crank(drive: &str, more: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ l: {{ value: 0.25, unit: m, tolerance: 1% }} }}
bodies:
  crank: {{ mass: 1, inertia: 0.002, points: {{ A: [-0.05, 0], B: [0.05, 0] }} }}
  rod: {{ mass: 0.8, inertia: 0.004, points: {{ B: [-l/2, 0], C: [l/2, 0] }} }}
  slider: {{ mass: 1.5, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  wrist: {{ revolute: [rod.C, slider] }}
  drive: {{ motor: {{ on: pivot, {drive} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  {more}
outputs: {{ x: slider.x, torque: drive.torque, pin: pin.force, angle: crank.angle }}
simulation: {{ duration: 0.6, output_step: 0.02, {simulation} }}
bounds: {{ chebyshev: {{ order: 4 }}, taylor: {{ order: 4 }} }}
"
    )
}

/// A crank that a lagging command turns is the same as one whose speed is prescribed as the command is: another
/// constraint, of positions.
#[test]
fn followed_and_prescribed_speed_give_the_same_motion() {
    let filter = "command: { filter: { input: 12 rad/s, numerator: [1], denominator: [0.1 s, 1] } }";
    for (simulation, of_motion, of_forces) in WAYS {
        for formulation in ["absolute", "joint"] {
            let simulation = format!("{simulation}, formulation: {formulation}");
            let followed = slider_crank("speed: command", filter, &simulation) + "initial: { crank.angle: 0 }";
            let prescribed = slider_crank("speed: 12*(1 - exp(-t/(0.1 s)))", "", &simulation);
            let [followed, prescribed] = [followed, prescribed].map(|text| run(&read(&text)));
            for name in ["x", "angle", "torque", "pin"] {
                let allowed = if matches!(name, "x" | "angle") { of_motion } else { of_forces };
                let off = distance(curve(&followed, name), curve(&prescribed, name));
                assert!(off < 10.0 * allowed, "{simulation}: {name} is off by {off:e}");
                for method in [Method::Chebyshev, Method::Taylor] {
                    let [a, b] = [&followed, &prescribed].map(|bounds| band(output(bounds, name), method));
                    let off = distance(&a.lower, &b.lower).max(distance(&a.upper, &b.upper));
                    let error = a.error.total.iter().chain(&b.error.total).copied().fold(0.0, f64::max);
                    assert!(off < 10.0 * allowed + 2.0 * error, "{simulation}: {method:?} of {name} is off by {off:e}");
                }
            }
        }
    }
}

/// Within its limits a rate limit makes a ramp, and the motor gives the power for it.
#[test]
fn a_motor_gives_the_power_for_a_ramp() {
    let lever = "  lever: { rate_limit: { input: 5 + 0*a.x, rate: 8, lag: 20 ms } }
  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }";
    let joints = "  j: { revolute: [a.P, b.P] }\n  drive: { motor: { on: j, speed: lever*(1 rad/s) } }";
    assert_balance(&pair(joints, lever, ""), "drive.torque*j.angular_velocity");
    let joints = "  j: { revolute: { between: [a.P, b.P], axis: [1, 2, 2] } }\n  drive: { motor: { on: j, speed: lever*(1 rad/s) } }";
    assert_balance(&spatial_pair(joints, lever, ""), "drive.torque*j.angular_velocity");
}

/// Two motors on joints with one axis: where both follow one state one of them is redundant, and they share the torque;
/// where each follows its own, nothing can fulfil both, though they begin alike; nor can a motor's position and a
/// state's speed.
#[test]
fn two_motors_agree_or_contradict() {
    let text = |other: &str| {
        pendulum("step: 2e-3, extrapolation: 4")
            .replace(
                "speed: command } }",
                &format!("speed: command }} }}\n  twin: {{ revolute: [ground, bar.A] }}\n  other: {{ motor: {{ on: twin, {other} }} }}"),
            )
            .replace("states: {", "states: { second: { rate: (3 rad/s - second)/lag, initial: 0 rad/s }, ")
            .replace("torque: drive.torque", "torque: drive.torque + other.torque, second: second")
    };
    let bounds = nominal(&read(&text("speed: command")));
    assert!(off(&bounds, "angle", |t| angle(0.2, t)) < 1e-10);
    assert!(off(&bounds, "torque", |t| torque(0.2, t)) < 1e-7);
    for (other, joint) in [("speed: second", "other"), ("position: 0.5 + 0*t", "drive")] {
        let error = refused(&text(other));
        assert!(error.contains(&format!("joint `{joint}` gives a speed by a state")), "{error}");
    }
}

/// A number held by a digital controller makes ramps of the speed: ẏ = 10 k T in the k-th period of T = 0.1 s.
#[test]
fn sampled_number_gives_piecewise_linear_speed() {
    let acceleration = |t: f64| ((t + 1e-9) / 0.1).floor();
    let rate = |t: f64| {
        let (periods, rest) = (acceleration(t), t - 0.1 * acceleration(t));
        0.1 * periods * (periods - 1.0) / 2.0 + periods * rest
    };
    for (simulation, of_motion, of_forces) in WAYS {
        let text = format!(
            "
bodies: {{ bar: {{ mass: 2, inertia: 0.05 }} }}
joints:
  hinge: {{ revolute: [ground, bar] }}
  drive: {{ motor: {{ on: hinge, speed: command }} }}
states: {{ command: {{ rate: held, initial: 0 rad/s }} }}
effects: {{ held: {{ sampled: {{ input: 10*t*(1 rad/s^3), period: 0.1 s }} }} }}
initial: {{ hinge.angle: 0 }}
outputs: {{ rate: hinge.angular_velocity, torque: drive.torque }}
simulation: {{ duration: 0.95, output_step: 0.05, {simulation} }}
"
        );
        let bounds = nominal(&read(&text));
        let [rate, torque] = [off(&bounds, "rate", rate), off(&bounds, "torque", |t| 0.05 * acceleration(t))];
        assert!(rate < of_motion && torque < of_forces, "{simulation}: {rate:e} {torque:e}");
    }
}
