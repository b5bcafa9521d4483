//! Nonlinear oscillators: coupled, with parameters that change in time, stick-slip, posts.

use std::f64::consts::{PI, TAU};

use super::stops::located;
use super::{Scale, integrated, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;
use crate::random::digits;

fn frequency(random: &mut Random, scale: &Scale) -> f64 {
    (random.scale(0.5, 6.0) * TAU / scale.duration).min(0.15 / scale.step)
}

/// Two masses between walls, with springs that harden.
pub fn coupled(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = frequency(random, scale);
    let x = random.scale(0.01, 1.0);
    let k = digits(omega * omega, 3);
    let weak = digits(k * random.scale(0.02, 2.0), 3);
    let cubic = digits(k / (x * x) * random.scale(0.05, 3.0), 3);
    let curves = integrated(
        0.15 / omega,
        |p| [p[4], 0.0, 0.0, 0.0],
        |p, _, y, d| {
            let [m, k, weak, cubic] = p[..4] else { unreachable!() };
            let apart = y[0] - y[1];
            let middle = weak * apart + cubic * apart * apart * apart;
            d.copy_from_slice(&[y[2], y[3], (-k * y[0] - cubic * y[0].powi(3) - middle) / m, -k * y[1] + middle]);
        },
        |_, _, y| [y[0], y[1], y[0] - y[1], y[3]],
    );
    Term {
        parameters: vec![
            parameter("m", place, 1.0, 0.1),
            parameter("k", place, k, 0.1),
            parameter("n", place, weak, 0.3),
            parameter("q", place, cubic, 0.3),
            parameter("x", place, x, 0.1),
        ],
        bodies: lines(&["b#: { mass: m#, coordinates: [x] }", "c#: { mass: 1, coordinates: [x] }"], place),
        joints: vec![],
        effects: lines(
            &[
                "f#: { force: { on: b#, value: [\"-k#*b#.x - q#*b#.x^3 - n#*(b#.x - c#.x) - q#*(b#.x - c#.x)^3\", 0] } }",
                "g#: { force: { on: c#, value: [\"-k#*c#.x + n#*(b#.x - c#.x) + q#*(b#.x - c#.x)^3\", 0] } }",
            ],
            place,
        ),
        initial: lines(&["b#.x: x#", "b#.vx: 0", "c#.x: 0", "c#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "c#.x", "b#.x - c#.x", "c#.vx"], place),
        curves,
        integrated: true,
        size: x,
        spatial: false,
        hidden: None,
    }
}

/// An oscillator whose stiffness oscillates, near its tongue of instability.
pub fn parametric(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = (random.scale(2.0, 12.0) * TAU / scale.duration).min(0.15 / scale.step);
    let k = digits(omega * omega, 3);
    let depth = digits(k * random.scale(0.05, 0.5), 3);
    let driven = digits(2.0 * omega * random.between(0.9, 1.1), 4);
    let damping = digits(2.0 * omega * random.scale(1e-3, 0.03), 3);
    let x = random.scale(0.01, 1.0);
    let curves = integrated(
        0.15 / omega,
        |p| [p[4], 0.0],
        |p, t, y, d| {
            let [k, depth, driven, damping] = p[..4] else { unreachable!() };
            (d[0], d[1]) = (y[1], -(k + depth * (driven * t).cos()) * y[0] - damping * y[1]);
        },
        |_, _, y| [y[0], y[1]],
    );
    Term {
        parameters: vec![
            parameter("k", place, k, 0.2),
            parameter("d", place, depth, 0.3),
            parameter("w", place, driven, 0.1),
            removable("c", place, damping, 0.5),
            parameter("x", place, x, 0.1),
        ],
        bodies: vec![named("b#: { mass: 1, coordinates: [x] }", place)],
        joints: vec![],
        effects: vec![named("f#: { force: { on: b#, value: [\"-(k# + d#*cos(w#*t))*b#.x - c#*b#.vx\", 0] } }", place)],
        initial: lines(&["b#.x: x#", "b#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves,
        integrated: true,
        size: x,
        spatial: false,
        hidden: None,
    }
}

/// A mass on a spring and a moving belt: it sticks and slips.
pub fn stick_slip(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = frequency(random, scale);
    let k = digits(omega * omega, 3);
    let belt = random.scale(0.05, 1.0);
    let friction = digits(belt * omega * random.scale(0.3, 3.0), 3);
    let regular = digits(belt * random.scale(0.01, 0.3), 2);
    let falling = random.between(0.0, 0.8);
    let curves = integrated(
        0.1 / omega,
        |_| [0.0, 0.0],
        |p, _, y, d| {
            let [k, belt, friction, regular, falling] = p[..5] else { unreachable!() };
            let slip = (belt - y[1]) / regular;
            let force = friction * slip.tanh() * (1.0 + falling * (-0.01 * slip * slip).exp());
            (d[0], d[1]) = (y[1], -k * y[0] + force);
        },
        |_, _, y| [y[0], y[1]],
    );
    let force = "f#: { force: { on: b#, value: [\"-k#*b#.x + F#*tanh((V# - b#.vx)/u#)*(1 + s#*exp(-0.01*((V# - b#.vx)/u#)^2))\", 0] } }";
    Term {
        parameters: vec![
            parameter("k", place, k, 0.1),
            parameter("V", place, belt, 0.1),
            parameter("F", place, friction, 0.1),
            parameter("u", place, regular, 0.0),
            removable("s", place, falling, 0.2),
        ],
        bodies: vec![named("b#: { mass: 1, coordinates: [x] }", place)],
        joints: vec![],
        effects: vec![named(force, place)],
        initial: lines(&["b#.x: 0", "b#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves,
        integrated: true,
        size: 2.0 * friction / k,
        spatial: false,
        hidden: None,
    }
}

/// A thrown ball, and a post that only some throws meet.
pub fn post(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let gravity = 9.81;
    let [right, up] = [0.5, 0.5].map(|share| digits(share * gravity * scale.duration * random.between(0.4, 1.4), 3));
    // Centre of the post: the position of a somewhat faster throw at half the time, and an offset in height.
    let (t, faster) = (0.5 * scale.duration, random.between(0.95, 1.05));
    let radius = digits(right * t * random.scale(0.01, 0.1), 2);
    let aside = random.between(-1.2, 1.2) * radius;
    let at = [faster * right * t, faster * up * t - 0.5 * gravity * t * t + aside].map(|x| digits(x, 4));
    let contact = random.scale(3.0, 50.0) * scale.step;
    let stiffness = digits((PI / contact).powi(2), 3);
    let speed = right.hypot(up);
    let size = speed * scale.duration;
    let curves = located(
        (radius / speed).min(0.3 * contact),
        [size, size, speed, speed],
        |p| [0.0, 0.0, p[0], p[1]],
        |p, y, sides| {
            let [_, _, x, height, radius, stiffness] = p[..6] else { unreachable!() };
            let [dx, dy] = [y[0] - x, y[1] - height];
            let distance = (dx * dx + dy * dy).sqrt();
            let push = if sides[0] { stiffness * (radius - distance) / distance } else { 0.0 };
            [y[2], y[3], push * dx, push * dy - 9.81]
        },
        |p, y| {
            let [dx, dy] = [y[0] - p[2], y[1] - p[3]];
            [p[4] - (dx * dx + dy * dy).sqrt()]
        },
        |y| [y[0], y[1], y[3]],
    );
    let distance = named("sqrt((b#.x - X#)^2 + (b#.y - Y#)^2)", place);
    let push = format!("K{place}*max(R{place} - {distance}, 0)/{distance}");
    let force = format!(
        "f{place}: {{ force: {{ on: b{place}, value: [\"{push}*(b{place}.x - X{place})\", \"{push}*(b{place}.y - Y{place})\"] }} }}"
    );
    Term {
        parameters: vec![
            parameter("u", place, right, 0.1),
            parameter("v", place, up, 0.1),
            parameter("X", place, at[0], 0.0),
            parameter("Y", place, at[1], 0.05),
            parameter("R", place, radius, 0.3),
            parameter("K", place, stiffness, 0.2),
        ],
        bodies: vec![named("b#: { mass: 1, coordinates: [x, y] }", place)],
        joints: vec![],
        effects: vec![named("g#: { gravity: { acceleration: [0, -9.81] } }", place), force],
        initial: lines(&["b#.x: 0", "b#.y: 0", "b#.vx: u#", "b#.vy: v#"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.y", "b#.vy"], place),
        curves,
        integrated: true,
        size,
        spatial: false,
        hidden: None,
    }
}
