//! Pendulums in their angles.

use std::f64::consts::PI;

use super::{Scale, integrated, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;
use crate::random::digits;

const GRAVITY: f64 = 9.81;

/// Length of a pendulum that swings so often within the duration, or with some 30 steps a swing.
fn length(random: &mut Random, scale: &Scale) -> f64 {
    let omega = (random.scale(0.5, 6.0) * 2.0 * PI / scale.duration).min(0.2 / scale.step);
    digits(GRAVITY / (omega * omega), 3)
}

/// A uniform rod on a hinge; some start near the upright, where a little decides which way it falls.
pub fn pendulum(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let l = length(random, scale);
    let high = random.scale(1e-3, 0.3);
    let any = random.between(-3.0, 1.4);
    let angle = digits(random.pick(&[any, any, 0.5 * PI - high]), 4);
    let omega = (GRAVITY / l).sqrt();
    let speed = if random.chance(0.5) { 0.0 } else { digits(omega * random.between(-2.5, 2.5), 3) };
    let curves = integrated(
        0.2 / omega,
        |p| [p[1], p[2]],
        |p, _, y, d| (d[0], d[1]) = (y[1], -1.5 * p[3] / p[0] * y[0].cos()),
        |p, _, y| {
            let [m, l, gravity] = [p[4], p[0], p[3]];
            let (sin, cos) = y[0].sin_cos();
            let turning = -1.5 * gravity / l * cos;
            // Acceleration of the centre; the reaction is the mass times its difference from gravity.
            let ax = 0.5 * l * (-sin * turning - cos * y[1] * y[1]);
            let ay = 0.5 * l * (cos * turning - sin * y[1] * y[1]);
            [y[0], y[1], l * cos, l * sin, m * ax.hypot(ay + gravity)]
        },
    );
    Term {
        parameters: vec![
            parameter("l", place, l, 0.1),
            parameter("a", place, angle, 0.05),
            removable("w", place, speed, 0.1),
            parameter("g", place, GRAVITY, 0.01),
            parameter("m", place, 1.0, 0.2),
        ],
        bodies: vec![named("b#: { mass: m#, inertia: m#*l#^2/12, points: { A: [-l#/2, 0], B: [l#/2, 0] } }", place)],
        joints: vec![named("j#: { revolute: [ground, b#.A] }", place)],
        effects: vec![named("f#: { gravity: { acceleration: [0, -g#] } }", place)],
        initial: lines(&["b#.angle: a#", "b#.angular_velocity: w#"], place),
        guess: vec![],
        channels: lines(&["b#.angle", "b#.angular_velocity", "b#.B.x", "b#.B.y", "j#.force"], place),
        curves,
        integrated: true,
        size: l,
        spatial: false,
        hidden: None,
    }
}

/// Two uniform rods.
pub fn double_pendulum(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let l = length(random, scale);
    let other = digits(l * random.scale(0.4, 1.5), 3);
    let wild = random.chance(0.3);
    let reach = if wild { 1.5 } else { 0.6 };
    let angles = [(); 2].map(|()| digits(-0.5 * PI + random.between(-reach, reach), 3));
    let mass = random.scale(0.2, 3.0);
    let curves = integrated(
        0.1 * (l / GRAVITY).sqrt(),
        |p| [p[3], p[4], 0.0, 0.0],
        |p, _, y, d| {
            let [l, other, m] = p[..3] else { unreachable!() };
            let [a, b, u, w] = y else { unreachable!() };
            let (s, c) = (a - b).sin_cos();
            let coupling = 0.5 * m * l * other;
            let [m11, m12, m22] = [(1.0 / 3.0 + m) * l * l, coupling * c, m * other * other / 3.0];
            let q1 = -coupling * s * w * w - (0.5 + m) * GRAVITY * l * a.cos();
            let q2 = coupling * s * u * u - 0.5 * m * GRAVITY * other * b.cos();
            let determinant = m11 * m22 - m12 * m12;
            d.copy_from_slice(&[*u, *w, (m22 * q1 - m12 * q2) / determinant, (m11 * q2 - m12 * q1) / determinant]);
        },
        |p, _, y| {
            let [l, other] = [p[0], p[1]];
            let (x, v) = (l * y[0].cos() + other * y[1].cos(), l * y[0].sin() + other * y[1].sin());
            [y[1], x, v, -l * y[2] * y[0].sin() - other * y[3] * y[1].sin()]
        },
    );
    Term {
        parameters: vec![
            parameter("l", place, l, 0.03),
            parameter("n", place, other, 0.03),
            parameter("m", place, mass, 0.05),
            parameter("a", place, angles[0], 0.02),
            parameter("q", place, angles[1], 0.02),
        ],
        bodies: lines(
            &[
                "b#: { mass: 1, inertia: l#^2/12, points: { A: [-l#/2, 0], B: [l#/2, 0] } }",
                "c#: { mass: m#, inertia: m#*n#^2/12, points: { B: [-n#/2, 0], C: [n#/2, 0] } }",
            ],
            place,
        ),
        joints: lines(&["j#: { revolute: [ground, b#.A] }", "k#: { revolute: [b#.B, c#.B] }"], place),
        effects: vec![named("f#: { gravity: { acceleration: [0, -9.81] } }", place)],
        initial: lines(&["b#.angle: a#", "b#.angular_velocity: 0", "c#.angle: q#", "c#.angular_velocity: 0"], place),
        guess: vec![],
        channels: lines(&["c#.angle", "c#.C.x", "c#.C.y", "c#.C.vx"], place),
        curves,
        integrated: true,
        size: l + other,
        spatial: false,
        hidden: None,
    }
}

/// A mass on a spring that swings, at any ratio of the two frequencies.
pub fn spring_pendulum(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let l = length(random, scale);
    let ratio = random.scale(1.3, 20.0).min(0.5 / scale.step / (GRAVITY / l).sqrt()).max(1.3);
    let m = random.scale(0.2, 5.0);
    let stiffness = digits(m * GRAVITY / l * ratio * ratio, 3);
    let angle = random.between(-1.2, 1.2);
    let curves = integrated(
        0.3 / (stiffness / m).sqrt(),
        |p| [p[2] * p[3].sin(), -p[2] * p[3].cos(), 0.0, 0.0],
        |p, _, y, d| {
            let [m, stiffness, l] = p[..3] else { unreachable!() };
            let distance = y[0].hypot(y[1]);
            let pull = -stiffness / m * (1.0 - l / distance);
            d.copy_from_slice(&[y[2], y[3], pull * y[0], pull * y[1] - GRAVITY]);
        },
        |p, _, y| [y[0], y[1], y[0].hypot(y[1]), p[1] * (y[0].hypot(y[1]) - p[2])],
    );
    Term {
        parameters: vec![
            parameter("m", place, m, 0.1),
            parameter("k", place, stiffness, 0.1),
            parameter("l", place, l, 0.05),
            parameter("a", place, angle, 0.1),
        ],
        bodies: vec![named("b#: { mass: m#, coordinates: [x, y] }", place)],
        joints: vec![],
        effects: lines(
            &[
                "f#: { gravity: { acceleration: [0, -9.81] } }",
                "s#: { spring_damper: { between: [ground, b#], stiffness: k#, free_length: l# } }",
            ],
            place,
        ),
        initial: lines(&["b#.x: l#*sin(a#)", "b#.y: -l#*cos(a#)", "b#.vx: 0", "b#.vy: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.y", "s#.length", "s#.force"], place),
        curves,
        integrated: true,
        size: l,
        spatial: false,
        hidden: None,
    }
}
