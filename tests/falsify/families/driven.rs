//! Nonlinear oscillators and pendulums that a force drives over many periods.

use std::f64::consts::{PI, TAU};

use super::{Scale, integrated, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::{Random, digits};

/// Frequency of a force with 2 to 10 periods in the duration, and at least some 30 steps a period.
fn driving(random: &mut Random, scale: &Scale) -> f64 {
    digits((random.scale(2.0, 10.0) * TAU / scale.duration).min(0.2 / scale.step), 4)
}

/// A spring that hardens, from rest anywhere between two positions.
pub fn hardening(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = driving(random, scale);
    let x = random.scale(0.05, 1.0);
    let k = digits((omega / random.scale(0.7, 2.0)).powi(2), 3);
    let cubic = digits(k / (x * x) * random.scale(0.1, 1.5), 3);
    let damping = digits(2.0 * k.sqrt() * random.scale(0.01, 0.1), 3);
    let force = digits(k * x * random.scale(0.1, 1.0), 3);
    let curves = integrated(
        0.1 / omega.max(k.sqrt()),
        |p| [p[5], 0.0],
        |p, t, y, d| {
            let [k, cubic, damping, force, omega] = p[..5] else { unreachable!() };
            (d[0], d[1]) = (y[1], -k * y[0] - cubic * y[0].powi(3) - damping * y[1] + force * (omega * t).cos());
        },
        |_, _, y| [y[0], y[1]],
    );
    let effect = "f#: { force: { on: b#, value: [\"-k#*b#.x - q#*b#.x^3 - c#*b#.vx + F#*cos(w#*t)\", 0] } }";
    Term {
        parameters: vec![
            parameter("k", place, k, 0.2),
            removable("q", place, cubic, 0.5),
            removable("c", place, damping, 0.5),
            removable("F", place, force, 0.4),
            parameter("w", place, omega, 0.02),
            parameter("x", place, x, 1.5),
        ],
        bodies: vec![named("b#: { mass: 1, coordinates: [x] }", place)],
        joints: vec![],
        effects: vec![named(effect, place)],
        initial: lines(&["b#.x: x#", "b#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves,
        integrated: true,
        size: 2.0 * x,
        spatial: false,
        hidden: None,
    }
}

/// A uniform rod on a hinge, driven by a torque.
pub fn pendulum(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = driving(random, scale);
    let own = omega / random.scale(0.6, 2.0);
    let l = digits(1.5 * 9.81 / (own * own), 3);
    let angle = digits(-0.5 * PI + random.between(-1.5, 1.5), 4);
    // Relative to the weight's own largest torque.
    let torque = digits(0.5 * 9.81 * l * random.scale(0.05, 0.8), 3);
    let damping = digits(2.0 * own * l * l / 3.0 * random.scale(0.01, 0.2), 3);
    let curves = integrated(
        0.1 / omega.max(own),
        |p| [p[1], 0.0],
        |p, t, y, d| {
            let [l, _, torque, damping, omega] = p[..5] else { unreachable!() };
            let driven = torque * (omega * t).cos() - damping * y[1];
            (d[0], d[1]) = (y[1], -1.5 * 9.81 / l * y[0].cos() + 3.0 * driven / (l * l));
        },
        |p, _, y| [y[0], y[1], p[0] * y[0].cos()],
    );
    Term {
        parameters: vec![
            parameter("l", place, l, 0.1),
            parameter("a", place, angle, 0.3),
            removable("T", place, torque, 0.4),
            removable("c", place, damping, 0.5),
            parameter("w", place, omega, 0.02),
        ],
        bodies: vec![named("b#: { mass: 1, inertia: l#^2/12, points: { A: [-l#/2, 0], B: [l#/2, 0] } }", place)],
        joints: vec![named("j#: { revolute: [ground, b#.A] }", place)],
        effects: lines(
            &[
                "g#: { gravity: { acceleration: [0, -9.81] } }",
                "d#: { torque: { on: b#, value: \"T#*cos(w#*t) - c#*b#.angular_velocity\" } }",
            ],
            place,
        ),
        initial: lines(&["b#.angle: a#", "b#.angular_velocity: 0"], place),
        guess: vec![],
        channels: lines(&["b#.angle", "b#.angular_velocity", "b#.B.x"], place),
        curves,
        integrated: true,
        size: l,
        spatial: false,
        hidden: None,
    }
}
