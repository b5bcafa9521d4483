//! Motors: prescribed motions against their formulas, and the torques that they take.

use mbint::results::Bounds;

use crate::common::power::{assert_balance, pair};
use crate::common::{Findings, curve, distance, distance_from, nominal, read, refused, row};

fn wheel(motor: &str) -> Bounds {
    nominal(&read(&format!(
        "
bodies: {{ wheel: {{ mass: 1, inertia: 0.02 }} }}
joints:
  shaft: {{ revolute: [ground, wheel] }}
  drive: {{ motor: {{ on: shaft, {motor} }} }}
outputs: {{ angle: wheel.angle, speed: wheel.angular_velocity, torque: drive.torque }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.01 }}
"
    )))
}

/// Speeds that are pieces of formulas: the areas under them.
#[test]
fn motors_follow_speeds_with_jumps_and_corners() {
    type Area = fn(f64) -> f64;
    let jump: Area = |t| if t < 0.75 { 2.0 * t } else { 1.5 - (t - 0.75) };
    let stairs: Area = |t| if t < 0.5 { 0.0 } else { t - 0.5 + (t - 1.0).max(0.0) + (t - 1.5).max(0.0) };
    let smooth: Area = |t| {
        let u = ((t - 0.25) / 0.5).clamp(0.0, 1.0);
        0.5 * (u.powi(3) - 0.5 * u.powi(4)) + (t - 0.75).max(0.0)
    };
    let mut findings = Findings::default();
    for (speed, area) in [
        ("if(t < 0.75 s, 2 rad/s, -1 rad/s)", jump),
        ("floor(t/(0.5 s))*(1 rad/s)", stairs),
        ("smoothstep(0.25 s, 0.75 s, t)*(1 rad/s)", smooth),
    ] {
        let bounds = wheel(&format!("from: 0.3, speed: \"{speed}\""));
        let angle = distance_from(&bounds.times, curve(&bounds, "angle"), |t| 0.3 + area(t));
        findings.check(angle < 1e-11, format_args!("{speed}: angle off by {angle:e}"));
    }
    findings.none();
}

/// Moves begin at 0.5 s and take 1 s: by their published laws of motion.
#[test]
fn motors_follow_their_profiles() {
    use std::f64::consts::TAU;
    type Law = fn(f64) -> [f64; 3];
    let cycloidal: Law = |u| [u - (TAU * u).sin() / TAU, 1.0 - (TAU * u).cos(), TAU * (TAU * u).sin()];
    let quintic: Law = |u| {
        [
            10.0 * u.powi(3) - 15.0 * u.powi(4) + 6.0 * u.powi(5),
            30.0 * u * u * (1.0 - u).powi(2),
            60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
        ]
    };
    // A quarter of the time each for both accelerations: the rate is 4/3 between.
    let trapezoidal: Law = |u| match u {
        u if u < 0.25 => [8.0 / 3.0 * u * u, 16.0 / 3.0 * u, 16.0 / 3.0],
        u if u < 0.75 => [1.0 / 6.0 + 4.0 / 3.0 * (u - 0.25), 4.0 / 3.0, 0.0],
        u => [1.0 - 8.0 / 3.0 * (1.0 - u).powi(2), 16.0 / 3.0 * (1.0 - u), -16.0 / 3.0],
    };
    let mut findings = Findings::default();
    for (name, law) in [("cycloidal", cycloidal), ("quintic", quintic), ("trapezoidal", trapezoidal)] {
        let bounds = wheel(&format!("profile: {name}, from: 0.3, to: 2.3, start: 0.5, duration: 1 s"));
        let at = |order: usize| {
            move |t: f64| match t {
                t if t <= 0.5 => [0.3, 0.0, 0.0][order],
                t if t >= 1.5 => [2.3, 0.0, 0.0][order],
                t => [0.3, 0.0, 0.0][order] + 2.0 * law(t - 0.5)[order],
            }
        };
        let angle = distance_from(&bounds.times, curve(&bounds, "angle"), at(0));
        findings.check(angle < 1e-11, format_args!("{name}: angle off by {angle:e}"));
        let speed = distance_from(&bounds.times, curve(&bounds, "speed"), at(1));
        findings.check(speed < 5e-3, format_args!("{name}: speed off by {speed:e}"));
        if name != "trapezoidal" {
            // Where the jerk jumps (to 2 · 60 rad/s³ at most), a step's acceleration is off by as much as a step
            // changes it.
            let torque = distance_from(&bounds.times, curve(&bounds, "torque"), |t| 0.02 * at(2)(t));
            findings.check(torque < 0.02 * 120.0 * 1e-3, format_args!("{name}: torque off by {torque:e}"));
        }
    }
    findings.none();
}

/// A run-up has half of the way of its final speed behind it at its end.
#[test]
fn motors_run_up() {
    for name in ["cycloidal", "quintic", "trapezoidal"] {
        let bounds = wheel(&format!("profile: {name}, speed: 6, from: 1, start: 0.2, duration: 0.8 s"));
        let angle = curve(&bounds, "angle");
        assert_eq!(angle[row(&bounds, 0.2)], 1.0);
        for t in [1.0, 1.4, 2.0] {
            let exact = 1.0 + 6.0 * (0.4 + t - 1.0);
            assert!((angle[row(&bounds, t)] - exact).abs() < 1e-11, "{name} at {t}");
        }
        assert!((curve(&bounds, "speed")[row(&bounds, 0.6)] - 3.0).abs() < 1e-3);
    }
}

#[test]
fn motors_turn_at_a_speed_and_by_a_formula() {
    let bounds = wheel("speed: 30 rpm, from: 10 deg");
    let exact = |t: f64| 10.0_f64.to_radians() + std::f64::consts::PI * t;
    assert!(distance_from(&bounds.times, curve(&bounds, "angle"), exact) < 1e-11);
    assert!(distance_from(&bounds.times, curve(&bounds, "torque"), |_| 0.0) < 1e-7);
    let bounds = wheel("position: 0.5*sin(3*t)");
    assert!(distance_from(&bounds.times, curve(&bounds, "angle"), |t| 0.5 * (3.0 * t).sin()) < 1e-11);
    // From 0.1 s on: in the first steps reactions have the start's error, which is of first order.
    let late = row(&bounds, 0.1);
    let exact = |t: f64| -0.02 * 4.5 * (3.0 * t).sin();
    let torque = distance_from(&bounds.times[late..], &curve(&bounds, "torque")[late..], exact);
    assert!(torque < 1e-6, "{torque:e}");
}

/// A speed by a formula is integrated by a formula: a ramp to 6 rad/s with a swing on top.
#[test]
fn a_motor_turns_at_a_speed_that_is_a_formula() {
    let bounds = wheel("speed: \"6*min(t/0.5, 1) + 0.5*sin(4*t)\", from: 1");
    let exact = |t: f64| {
        let ramp = if t < 0.5 { 6.0 * t * t } else { 1.5 + 6.0 * (t - 0.5) };
        1.0 + ramp + 0.125 * (1.0 - (4.0 * t).cos())
    };
    assert!(distance_from(&bounds.times, curve(&bounds, "angle"), exact) < 1e-11);
    let late = row(&bounds, 0.6);
    let torque = |t: f64| 0.02 * 2.0 * (4.0 * t).cos();
    let off = distance_from(&bounds.times[late..], &curve(&bounds, "torque")[late..], torque);
    assert!(off < 1e-5, "{off:e}");
}

/// A lift that a motor raises along z: it carries the weight.
#[test]
fn motor_in_space_carries_the_weight_of_a_lift() {
    let bounds = nominal(&read(
        "
bodies: { cage: { mass: 3, inertia: [1, 1, 1] } }
joints:
  guide: { prismatic: { between: [ground, cage], axis: z } }
  hoist: { motor: { on: guide, profile: quintic, to: 2, duration: 1 } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
outputs: { z: cage.z, force: hoist.force.z, guide: guide.force }
simulation: { duration: 2, step: 1e-3, output_step: 0.01 }
",
    ));
    assert!((curve(&bounds, "z").last().unwrap() - 2.0).abs() < 1e-10);
    assert!((curve(&bounds, "force").last().unwrap() - 3.0 * 9.81).abs() < 1e-6);
    let highest = curve(&bounds, "force").iter().copied().fold(0.0, f64::max);
    // The quintic's largest acceleration is 10/√3 of way over duration squared.
    assert!((highest - 3.0 * (9.81 + 2.0 * 10.0 / 3.0_f64.sqrt())).abs() < 0.05, "{highest}");
}

/// A prescribed motion by a table: the motor's coordinate is the spline.
#[test]
fn a_motor_follows_a_table() {
    let bounds = nominal(&read(
        "
tables: { cam: { points: [[0, 0], [0.5, 0.1], [1, 0.3], [1.5, 0.2], [2, 0]], units: [s, rad] } }
bodies: { wheel: { mass: 1, inertia: 0.02 } }
joints:
  shaft: { revolute: [ground, wheel] }
  drive: { motor: { on: shaft, position: cam(t) } }
outputs: { angle: wheel.angle, wanted: cam(t) }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
",
    ));
    assert!(distance(curve(&bounds, "angle"), curve(&bounds, "wanted")) < 1e-12);
    assert!((curve(&bounds, "angle")[10] - 0.3).abs() < 1e-12);
}

#[test]
fn power_is_torque_times_rate() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }\n  drive: { motor: { on: j, position: 0.3 + sin(3*t) } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "",
        ),
        "drive.torque*j.angular_velocity",
    );
}

/// A motor's torque and force in space have the sign of the joint's axis, and are those of Newton's law.
#[test]
fn torque_and_force_in_space_have_the_sign_of_the_axis() {
    let ask = |formulation: &str| {
        nominal(&read(&format!(
            "
space: spatial
bodies:
  wheel: {{ mass: 1, inertia: [0.1, 0.3, 0.2] }}
  slider: {{ mass: 2.5, inertia: [0.1, 0.1, 0.1] }}
joints:
  hinge: {{ revolute: {{ between: [ground, wheel], axis: [0, -1, 0] }} }}
  slide: {{ prismatic: {{ between: [ground, slider], axis: [0, 0, 1] }} }}
  drive: {{ motor: {{ on: hinge, position: 0.5*sin(3*t) }} }}
  lift: {{ motor: {{ on: slide, position: 0.2*cos(2*t) }} }}
outputs: {{ torque: drive.torque, about: drive.torque.axial, y: drive.torque.y, axial: lift.axial, force: lift.force }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.1, formulation: {formulation} }}
"
        )))
    };
    for bounds in ["absolute", "joint"].map(ask) {
        let torque = |t: f64| 0.3 * -4.5 * (3.0 * t).sin();
        let force = |t: f64| 2.5 * -0.8 * (2.0 * t).cos();
        let laws: [(&str, &dyn Fn(f64) -> f64); 5] = [
            ("torque", &torque),
            ("about", &torque),
            ("y", &|t| -torque(t)),
            ("axial", &force),
            ("force", &|t| force(t).abs()),
        ];
        for (name, law) in laws {
            let error = distance_from(&bounds.times, curve(&bounds, name), law);
            assert!(error < 1e-4, "{name}: {error:e}");
        }
    }
}

/// Motors that begin alike and part: on two hinges with one axis, and on bodies that gears couple. They are beyond 1e-4
/// rad where 0.2 t³ is, after eight steps; where both say the same, one is redundant and nothing is wrong.
#[test]
fn diverging_motors_are_reported_with_the_time() {
    let hinges = |more: &str| {
        format!(
            "
bodies: {{ bar: {{ mass: 2, inertia: 0.05, points: {{ A: [-0.3, 0] }} }} }}
joints:
  hinge: {{ revolute: [ground, bar.A] }}
  twin: {{ revolute: [ground, bar.A] }}
  one: {{ motor: {{ on: hinge, position: t*(1 rad/s) }} }}
  two: {{ motor: {{ on: twin, position: t*(1 rad/s){more} }} }}
outputs: {{ x: bar.angle }}
simulation: {{ duration: 0.5, step: 1e-2 }}
"
        )
    };
    let gears = |more: &str| {
        format!(
            "
bodies: {{ bar: {{ inertia: 0.05, coordinates: [angle] }}, rim: {{ inertia: 0.05, coordinates: [angle] }} }}
joints:
  mesh: {{ gear: {{ between: [bar, rim], ratio: -1 }} }}
  one: {{ equation: \"bar.angle = t*(1 rad/s)\" }}
  two: {{ equation: \"rim.angle = -(t*(1 rad/s){more})\" }}
outputs: {{ x: bar.angle }}
simulation: {{ duration: 0.5, step: 1e-2 }}
"
        )
    };
    for text in [hinges(" + 0.2*t^3*(1 rad/s^3)"), gears(" + 0.2*t^3*(1 rad/s^3)")] {
        let message = refused(&text);
        assert!(message.contains("joint `two` contradicts") && message.contains("t = 0.08 s"), "{message}");
        // The explicit method follows the first in the same way.
        let explicit = text.replace("step: 1e-2", "tolerance: 1e-6, output_step: 1e-2, scheme: explicit");
        assert_ne!(explicit, text);
        let message = refused(&explicit);
        assert!(message.contains("joint `two` contradicts") && message.contains("t = 0.08 s"), "{message}");
    }
    for text in [hinges(""), gears("")] {
        let bounds = nominal(&read(&text));
        assert!(distance_from(&bounds.times, curve(&bounds, "x"), |t| t) < 1e-9);
    }
}
