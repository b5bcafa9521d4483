//! A mass that friction stops, and one that falls against a fluid.

use super::pulses::integral;
use super::{Scale, closed_form, lines, named, parameter};
use crate::draw::Term;
use crate::random::Random;

/// asinh(e^y), whatever e^y is.
fn asinh_exp(y: f64) -> f64 {
    if y > 20.0 { y + std::f64::consts::LN_2 } else { y.exp().asinh() }
}

/// v' = −a tanh(v/u): sinh(v/u) falls exponentially.
pub fn friction(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let [mu, gravity] = [random.between(0.05, 0.8), 9.81];
    // It comes to rest between a third of the duration and beyond its end.
    let speed = crate::random::digits(mu * gravity * scale.duration * random.between(0.3, 1.3), 3);
    let regular = crate::random::digits(speed * random.scale(1e-3, 0.3), 2);
    let curves = closed_form(|p, t| {
        let [mu, gravity, speed, regular] = p[..4] else { unreachable!() };
        let rate = mu * gravity / regular;
        let u = speed / regular;
        // The logarithm of sinh(u).
        let from = u + (0.5 * (1.0 - (-2.0 * u).exp())).ln();
        let to = from - rate * t;
        // Panels of half a unit of the logarithm where the integrand bends, none where it is straight or 0.
        let (bend, flat) = (to.max(20.0_f64.min(from)), to.max(-40.0));
        let straight = 0.5 * (from - bend) * (from + bend + 2.0 * std::f64::consts::LN_2);
        let bent = if bend > flat {
            integral(flat, bend, 1 + (2.0 * (bend - flat)) as usize, |y| [asinh_exp(y), 0.0])[0]
        } else {
            0.0
        };
        [regular / rate * (straight + bent), regular * asinh_exp(to)]
    });
    Term {
        parameters: vec![
            parameter("f", place, mu, 0.2),
            parameter("g", place, gravity, 0.01),
            parameter("v", place, speed, 0.1),
            parameter("u", place, regular, 0.3),
        ],
        bodies: vec![named("b#: { mass: 2, coordinates: [x] }", place)],
        joints: vec![],
        effects: vec![named("f#: { force: { on: b#, value: [\"-f#*2*g#*tanh(b#.vx/u#)\", 0] } }", place)],
        initial: lines(&["b#.x: 0", "b#.vx: v#"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves,
        integrated: false,
        size: speed * scale.duration,
        spatial: false,
        hidden: None,
    }
}

/// A fall against resistance by the square of the speed: v = w tanh(gt/w).
pub fn drag(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let gravity = 9.81;
    let terminal = gravity * scale.duration * random.scale(0.05, 2.0);
    let m = random.scale(0.1, 10.0);
    let resistance = crate::random::digits(m * gravity / (terminal * terminal), 3);
    let curves = closed_form(|p, t| {
        let [m, gravity, resistance] = p[..3] else { unreachable!() };
        let terminal = (m * gravity / resistance).sqrt();
        let s = gravity * t / terminal;
        // The logarithm of cosh(s).
        let log = s + (0.5 * (1.0 + (-2.0 * s).exp())).ln();
        [-terminal * terminal / gravity * log, -terminal * s.tanh(), -gravity / s.cosh().powi(2)]
    });
    Term {
        parameters: vec![
            parameter("m", place, m, 0.2),
            parameter("g", place, gravity, 0.02),
            parameter("q", place, resistance, 0.3),
        ],
        bodies: vec![named("b#: { mass: m#, coordinates: [y] }", place)],
        joints: vec![],
        effects: lines(&["f#: { force: { on: b#, value: [0, \"-m#*g# - q#*b#.vy*abs(b#.vy)\"] } }"], place),
        initial: lines(&["b#.y: 0", "b#.vy: 0"], place),
        guess: vec![],
        channels: lines(&["b#.y", "b#.vy", "b#.ay"], place),
        curves,
        integrated: false,
        size: terminal * scale.duration,
        spatial: false,
        hidden: None,
    }
}
