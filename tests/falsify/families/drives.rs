//! Mechanisms with joints whose motion is known: a rotor under a constant torque, and linkages driven at constant
//! speed.

use std::f64::consts::TAU;

use super::{Scale, closed_form, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;

/// A body on a hinge, under a constant torque: angle, position, speed, and the force of the hinge.
pub fn rotor(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let turns = random.scale(0.2, 20.0);
    let omega = crate::random::digits((turns * TAU / scale.duration).min(0.3 / scale.step), 3);
    let [m, r] = [random.scale(0.1, 10.0), random.scale(0.05, 2.0)];
    let inertia = crate::random::digits(m * r * r * random.scale(0.05, 1.0), 3);
    let gain = random.between(-1.0, 1.0) * omega / scale.duration;
    let torque = if random.chance(0.3) { 0.0 } else { crate::random::digits(gain * (inertia + m * r * r), 3) };
    let curves = closed_form(|p, t| {
        let [m, r, inertia, omega, torque] = p[..5] else { unreachable!() };
        let acceleration = torque / (inertia + m * r * r);
        let angle = omega * t + 0.5 * acceleration * t * t;
        let speed = omega + acceleration * t;
        let (sin, cos) = angle.sin_cos();
        [angle, r * cos, r * sin, -r * speed * sin, m * r * acceleration.hypot(speed * speed)]
    });
    Term {
        parameters: vec![
            parameter("m", place, m, 0.2),
            parameter("r", place, r, 0.1),
            parameter("J", place, inertia, 0.3),
            parameter("w", place, omega, 0.1),
            removable("T", place, torque, 0.3),
        ],
        bodies: vec![named("b#: { mass: m#, inertia: J#, points: { A: [-r#, 0] } }", place)],
        joints: vec![named("j#: { revolute: [ground, b#.A] }", place)],
        effects: vec![named("f#: { torque: { on: b#, value: T# } }", place)],
        initial: lines(&["b#.angle: 0", "b#.angular_velocity: w#"], place),
        guess: vec![],
        channels: lines(&["b#.angle", "b#.x", "b#.y", "b#.vx", "j#.force"], place),
        curves,
        integrated: false,
        size: r,
        spatial: false,
        hidden: None,
    }
}

/// Crank speed and its bars' lengths.
fn speed(random: &mut Random, scale: &Scale) -> f64 {
    let turns = random.scale(0.2, 10.0);
    crate::random::digits((turns * TAU / scale.duration).min(0.3 / scale.step), 3)
}

const CRANK: [&str; 2] = [
    "c#: { mass: 1, inertia: 0.01, points: { A: [-r#/2, 0], B: [r#/2, 0] } }",
    "d#: { mass: 1, inertia: 0.02, points: { B: [-l#/2, 0], C: [l#/2, 0] } }",
];

/// A slider crank whose crank turns at constant speed; the slider's path is off the crank's centre by e.
pub fn slider_crank(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let r = random.scale(0.05, 1.0);
    // A rod hardly longer than the crank nearly stands across.
    let l = crate::random::digits(r * random.pick(&[1.3, 2.0, 3.7]), 3);
    let offset = if random.chance(0.5) { 0.0 } else { crate::random::digits(0.1 * r, 2) };
    let omega = speed(random, scale);
    let curves = closed_form(|p, t| {
        let [r, l, offset, omega] = p[..4] else { unreachable!() };
        let (sin, cos) = (omega * t).sin_cos();
        let rise = offset - r * sin;
        let base = (l * l - rise * rise).sqrt();
        [r * cos + base, -r * omega * sin + rise * r * omega * cos / base]
    });
    Term {
        parameters: vec![
            parameter("r", place, r, 0.05),
            parameter("l", place, l, 0.05),
            removable("e", place, offset, 0.3),
            parameter("w", place, omega, 0.1),
        ],
        bodies: [lines(&CRANK, place), vec![named("s#: { mass: 1, coordinates: [x], held: { y: e# } }", place)]]
            .concat(),
        joints: lines(
            &["p#: { revolute: [ground, c#.A] }", "q#: { revolute: [c#.B, d#.B] }", "u#: { revolute: [d#.C, s#] }"],
            place,
        )
        .into_iter()
        .chain([named("z#: { equation: \"c#.angle = w#*t\" }", place)])
        .collect(),
        effects: vec![],
        initial: vec![],
        guess: lines(&["s#.x: r# + l#"], place),
        channels: lines(&["s#.x", "s#.vx"], place),
        curves,
        integrated: false,
        size: r + l,
        spatial: false,
        hidden: None,
    }
}

/// A crank-rocker whose crank turns at constant speed: the rocker's angle.
pub fn four_bar(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let base = random.scale(0.2, 2.0);
    let [r, l, s] = random.pick(&[[0.333, 0.867, 0.733], [0.3, 1.0, 0.9], [0.4, 0.8, 0.85]]);
    let [r, l, s] = [r, l, s].map(|length| crate::random::digits(base * length, 3));
    let omega = speed(random, scale);
    let curves = closed_form(|p, t| {
        let [base, r, l, s, omega] = p[..5] else { unreachable!() };
        let (sin, cos) = (omega * t).sin_cos();
        // From the rocker's bearing to the crank's end, and the triangle of coupler and rocker on it.
        let [dx, dy] = [r * cos - base, r * sin];
        let diagonal = dx.hypot(dy);
        let inside = ((diagonal * diagonal + s * s - l * l) / (2.0 * diagonal * s)).acos();
        let direction = dy.atan2(dx);
        // The crank's end is left of the bearing: its direction is near π, whatever its sign.
        let direction = if direction < 0.0 { direction + TAU } else { direction };
        let angle = direction - inside;
        [angle, base + s * angle.cos(), s * angle.sin()]
    });
    let ground = named("ground: { points: { F#: [B#, 0] } }", place);
    let rocker = named("e#: { mass: 1, inertia: 0.01, points: { D: [-s#/2, 0], C: [s#/2, 0] } }", place);
    Term {
        parameters: vec![
            parameter("B", place, base, 0.02),
            parameter("r", place, r, 0.05),
            parameter("l", place, l, 0.02),
            parameter("s", place, s, 0.02),
            parameter("w", place, omega, 0.1),
        ],
        bodies: [vec![ground], lines(&CRANK, place), vec![rocker]].concat(),
        joints: lines(
            &[
                "p#: { revolute: [ground, c#.A] }",
                "q#: { revolute: [c#.B, d#.B] }",
                "u#: { revolute: [d#.C, e#.C] }",
                "x#: { revolute: [ground.F#, e#.D] }",
                "z#: { equation: \"c#.angle = w#*t\" }",
            ],
            place,
        ),
        effects: vec![],
        initial: vec![],
        guess: lines(&["d#.angle: 50 deg", "e#.angle: 110 deg"], place),
        channels: lines(&["e#.angle", "e#.C.x", "e#.C.y"], place),
        curves,
        integrated: false,
        size: base + l,
        spatial: false,
        hidden: None,
    }
}
