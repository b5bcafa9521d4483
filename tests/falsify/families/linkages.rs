//! Linkages that move freely, in the angle of their crank: I θ″ + ½ I′ θ′² = Q, where I and Q are those of all bodies.

use std::f64::consts::TAU;

use super::{Scale, integrated, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;
use crate::random::digits;

/// A body's centre and angle as functions of the crank's angle: first and second derivatives.
struct Ride {
    mass: f64,
    inertia: f64,
    first: [f64; 3],
    second: [f64; 3],
}

/// θ″ from the bodies' motions, their weights and the crank's torque.
fn acceleration(rides: &[Ride], speed: f64, torque: f64, gravity: f64) -> f64 {
    let (mut inertia, mut change, mut force) = (0.0, 0.0, torque);
    for Ride { mass, inertia: of_body, first, second } in rides {
        for (axis, weight) in [mass, mass, of_body].into_iter().enumerate() {
            inertia += weight * first[axis] * first[axis];
            change += weight * first[axis] * second[axis];
        }
        force -= mass * gravity * first[1];
    }
    (force - change * speed * speed) / inertia
}

/// A bar's end at a distance along a direction that turns: derivatives, on top of those of its beginning.
fn along(from: [[f64; 2]; 2], length: f64, angle: f64, first: f64, second: f64) -> [[f64; 2]; 2] {
    let (sin, cos) = angle.sin_cos();
    [
        [from[0][0] - length * sin * first, from[0][1] + length * cos * first],
        [
            from[1][0] - length * (cos * first * first + sin * second),
            from[1][1] + length * (cos * second - sin * first * first),
        ],
    ]
}

/// A uniform bar of this mass.
fn bar(from: [[f64; 2]; 2], mass: f64, length: f64, [angle, first, second]: [f64; 3]) -> Ride {
    let [v, a] = along(from, 0.5 * length, angle, first, second);
    Ride { mass, inertia: mass * length * length / 12.0, first: [v[0], v[1], first], second: [a[0], a[1], second] }
}

const REST: [[f64; 2]; 2] = [[0.0; 2]; 2];

/// Angle of a slider crank's rod, and its derivatives.
fn rod(r: f64, l: f64, angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let tilt = (-r * sin / l).asin();
    let first = -r * cos / (l * tilt.cos());
    [tilt, first, (r * sin / l + tilt.sin() * first * first) / tilt.cos()]
}

/// A slider crank under a torque, a spring and a damper at the slider.
pub fn slider_crank(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let r = random.scale(0.05, 0.5);
    let l = digits(r * random.pick(&[1.4, 2.5, 4.0]), 3);
    let [m1, m2, m3] = [(); 3].map(|()| random.scale(0.2, 2.0));
    let omega = digits((random.scale(0.3, 5.0) * TAU / scale.duration).min(0.15 / scale.step), 3);
    let inertia = m1 * r * r / 3.0 + (m2 + m3) * r * r;
    let torque = digits(inertia * omega / scale.duration * random.between(-1.0, 1.0), 3);
    let spring = digits(inertia * omega * omega / (r * r) * random.between(0.0, 0.3), 3);
    let damper = digits(m3 * omega * random.between(0.0, 0.2), 3);
    let curves = integrated(
        0.05 / omega,
        |p| [0.5, p[5]],
        |p, _, y, d| {
            let [r, l, m1, m2, m3, _, torque, spring, damper] = p[..9] else { unreachable!() };
            let rod_angle = rod(r, l, y[0]);
            let crank = [y[0], 1.0, 0.0];
            let pin = along(REST, r, y[0], 1.0, 0.0);
            let wrist = along(pin, l, rod_angle[0], rod_angle[1], rod_angle[2]);
            let slider =
                Ride { mass: m3, inertia: 0.0, first: [wrist[0][0], 0.0, 0.0], second: [wrist[1][0], 0.0, 0.0] };
            let x = r * y[0].cos() + l * rod_angle[0].cos();
            let push = -spring * (x - l) - damper * wrist[0][0] * y[1];
            let rides = [bar(REST, m1, r, crank), bar(pin, m2, l, rod_angle), slider];
            (d[0], d[1]) = (y[1], acceleration(&rides, y[1], torque + push * wrist[0][0], 0.0));
        },
        |p, _, y| {
            let [r, l] = [p[0], p[1]];
            let rod_angle = rod(r, l, y[0]);
            let x = r * y[0].cos() + l * rod_angle[0].cos();
            let v = (-r * y[0].sin() - l * rod_angle[0].sin() * rod_angle[1]) * y[1];
            [x, v, y[0]]
        },
    );
    Term {
        parameters: vec![
            parameter("r", place, r, 0.02),
            parameter("l", place, l, 0.02),
            parameter("m", place, m1, 0.1),
            parameter("n", place, m2, 0.1),
            parameter("o", place, m3, 0.1),
            parameter("w", place, omega, 0.05),
            removable("T", place, torque, 0.2),
            removable("k", place, spring, 0.1),
            removable("c", place, damper, 0.3),
        ],
        bodies: lines(
            &[
                "b#: { mass: m#, inertia: m#*r#^2/12, points: { A: [-r#/2, 0], B: [r#/2, 0] } }",
                "d#: { mass: n#, inertia: n#*l#^2/12, points: { B: [-l#/2, 0], C: [l#/2, 0] } }",
                "s#: { mass: o#, coordinates: [x] }",
            ],
            place,
        ),
        joints: lines(
            &["p#: { revolute: [ground, b#.A] }", "q#: { revolute: [b#.B, d#.B] }", "u#: { revolute: [d#.C, s#] }"],
            place,
        ),
        effects: lines(
            &[
                "f#: { torque: { on: b#, value: T# } }",
                "g#: { force: { on: s#, value: [\"-k#*(s#.x - l#) - c#*s#.vx\", 0] } }",
            ],
            place,
        ),
        initial: lines(&["b#.angle: 0.5", "b#.angular_velocity: w#"], place),
        guess: lines(&["s#.x: r# + l#"], place),
        channels: lines(&["s#.x", "s#.vx", "b#.angle"], place),
        curves,
        integrated: true,
        size: r + l,
        spatial: false,
        hidden: None,
    }
}

/// Angles of a four-bar's coupler and rocker with their derivatives: r e^{iθ} + l e^{iφ} = B + s e^{iψ}.
fn loop_angles([base, r, l, s]: [f64; 4], angle: f64) -> [[f64; 3]; 2] {
    let (sin, cos) = angle.sin_cos();
    let [dx, dy] = [r * cos - base, r * sin];
    let diagonal = dx.hypot(dy);
    let direction = dy.atan2(dx);
    let direction = if direction < 0.0 { direction + TAU } else { direction };
    let rocker = direction - ((diagonal * diagonal + s * s - l * l) / (2.0 * diagonal * s)).acos();
    let [cx, cy] = [base + s * rocker.cos(), s * rocker.sin()];
    let coupler = (cy - r * sin).atan2(cx - r * cos);
    // l e^{iφ} i φ′ − s e^{iψ} i ψ′ = −r e^{iθ} i, and its derivative.
    let ([sl, cl], [ss, cs]) = ([l * coupler.sin(), l * coupler.cos()], [s * rocker.sin(), s * rocker.cos()]);
    let solve = |x: f64, y: f64| {
        // −sl φ + ss ψ = x,  cl φ − cs ψ = y
        let determinant = sl * cs - cl * ss;
        [(-cs * x - ss * y) / determinant, (-cl * x - sl * y) / determinant]
    };
    let [phi, psi] = solve(r * sin, -r * cos);
    let [phi2, psi2] = solve(r * cos + cl * phi * phi - cs * psi * psi, r * sin + sl * phi * phi - ss * psi * psi);
    [[coupler, phi, phi2], [rocker, psi, psi2]]
}

/// A crank-rocker with weight, thrown.
pub fn four_bar(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let omega = digits((random.scale(0.3, 4.0) * TAU / scale.duration).min(0.15 / scale.step), 3);
    let base = random.scale(0.2, 2.0);
    let shape = random.pick(&[[0.333, 0.867, 0.733], [0.3, 1.0, 0.9], [0.4, 0.8, 0.85]]);
    let [r, l, s] = shape.map(|length| digits(base * length, 3));
    // The weights slow it down, and speed it up.
    let gravity = digits(omega * omega * r * random.between(0.0, 1.0), 3);
    let line = random.scale(0.5, 2.0);
    let curves = integrated(
        0.05 / omega,
        |p| [0.7, p[4]],
        |p, _, y, d| {
            let [base, r, l, s, _, gravity, line] = p[..7] else { unreachable!() };
            let [coupler, rocker] = loop_angles([base, r, l, s], y[0]);
            let pin = along(REST, r, y[0], 1.0, 0.0);
            let rides =
                [bar(REST, line * r, r, [y[0], 1.0, 0.0]), bar(pin, line * l, l, coupler), bar(REST, s, s, rocker)];
            (d[0], d[1]) = (y[1], acceleration(&rides, y[1], 0.0, gravity));
        },
        |p, _, y| {
            let [coupler, rocker] = loop_angles([p[0], p[1], p[2], p[3]], y[0]);
            [y[0], y[1], rocker[0], coupler[0], rocker[1] * y[1]]
        },
    );
    Term {
        parameters: vec![
            parameter("B", place, base, 0.01),
            parameter("r", place, r, 0.02),
            parameter("l", place, l, 0.01),
            parameter("s", place, s, 0.01),
            parameter("w", place, omega, 0.05),
            removable("g", place, gravity, 0.02),
            parameter("n", place, line, 0.1),
        ],
        bodies: lines(
            &[
                "ground: { points: { F#: [B#, 0] } }",
                "b#: { mass: n#*r#, inertia: n#*r#^3/12, points: { A: [-r#/2, 0], B: [r#/2, 0] } }",
                "d#: { mass: n#*l#, inertia: n#*l#^3/12, points: { B: [-l#/2, 0], C: [l#/2, 0] } }",
                "e#: { mass: s#, inertia: s#^3/12, points: { D: [-s#/2, 0], C: [s#/2, 0] } }",
            ],
            place,
        ),
        joints: lines(
            &[
                "p#: { revolute: [ground, b#.A] }",
                "q#: { revolute: [b#.B, d#.B] }",
                "u#: { revolute: [d#.C, e#.C] }",
                "x#: { revolute: [ground.F#, e#.D] }",
            ],
            place,
        ),
        effects: vec![named("f#: { gravity: { acceleration: [0, -g#] } }", place)],
        initial: lines(&["b#.angle: 0.7", "b#.angular_velocity: w#"], place),
        guess: lines(&["d#.angle: 50 deg", "e#.angle: 110 deg"], place),
        channels: lines(&["b#.angle", "b#.angular_velocity", "e#.angle", "d#.angle", "e#.angular_velocity"], place),
        curves,
        integrated: true,
        size: base + l,
        spatial: false,
        hidden: None,
    }
}
