//! Motions of many impacts: a pawl over teeth, a pin in its clearance. Truths locate every impact.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use super::{Scale, lines, named, parameter};
use crate::dop853;
use crate::draw::{Curves, Term};
use crate::random::{Random, digits};

/// Error of each step, relative to the size of the state.
const TOLERANCE: f64 = 1e-14;

/// Curves of motions that switch, located; steps are at most `longest`, s, long. `units` are sizes of the state: errors
/// of steps are shares of them.
pub fn located<const N: usize, const S: usize, const C: usize>(
    longest: f64,
    units: [f64; N],
    start: impl Fn(&[f64]) -> [f64; N] + Send + Sync + 'static,
    slope: impl Fn(&[f64], &[f64; N], &[bool]) -> [f64; N] + Send + Sync + 'static,
    switches: impl Fn(&[f64], &[f64; N]) -> [f64; S] + Send + Sync + 'static,
    observe: impl Fn(&[f64; N]) -> [f64; C] + Send + Sync + 'static,
) -> Curves {
    let in_si = move |y: &[f64]| -> [f64; N] { std::array::from_fn(|i| units[i] * y[i]) };
    Arc::new(move |p, times| {
        let slope = |_: f64, y: &[f64], sides: &[bool], d: &mut [f64]| {
            let rates = slope(p, &in_si(y), sides);
            d.iter_mut().zip(rates).zip(units).for_each(|((d, rate), unit)| *d = rate / unit);
        };
        let switches = |_: f64, y: &[f64]| switches(p, &in_si(y));
        let mut start = start(p);
        start.iter_mut().zip(units).for_each(|(value, unit)| *value /= unit);
        let solution = dop853::solve_located(slope, switches, &start, times, TOLERANCE, longest);
        let mut curves = vec![Vec::with_capacity(times.len()); C];
        for y in &solution {
            curves.iter_mut().zip(observe(&in_si(y))).for_each(|(curve, value)| curve.push(value));
        }
        curves
    })
}

/// A slide that is pushed over two teeth of a rack, and pulled back by a spring; a pawl on a spring of its own falls
/// behind the teeth that it passed, and holds the slide there. Some slides of the box pass one tooth more than others.
pub fn ratchet(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let tooth = 0.01;
    let height = digits(tooth * random.between(0.2, 0.5), 2);
    let steep = digits(tooth * random.between(0.1, 0.4), 2);
    // It comes back from two to five teeth after a third to all of the duration.
    let omega = PI / (scale.duration * random.between(0.3, 1.0));
    let back = digits(omega * omega, 3);
    let speed = digits(omega * tooth * random.between(1.0, 3.5), 3);
    let pawl = digits(random.scale(0.02, 0.3), 2);
    let contact = PI / (random.scale(0.005, 0.05) * scale.duration);
    let stiffness = digits(pawl * contact * contact, 3);
    let press = digits(pawl * (0.2 * contact).powi(2) * random.between(0.3, 1.0), 3);
    let damper = digits(pawl * contact * random.between(0.3, 1.5), 2);
    let first = digits(tooth * random.between(0.2, 0.8), 2);
    // The rack at x: height and slope of each piece.
    let rack = move |x: f64, height: f64| -> [[f64; 2]; 4] {
        let of = |begin: f64| {
            let (up, down) = (height / (tooth - steep), height / steep);
            [[up * (x - begin), up], [down * (begin + tooth - x), -down]]
        };
        let [[a, b], [c, d]] = [of(first), of(first + tooth)];
        [a, b, c, d]
    };
    // Positions of the corners of the rack.
    let corners = [first, first + tooth - steep, first + tooth, first + 2.0 * tooth - steep, first + 2.0 * tooth];
    let piece = |beyond: &[bool]| beyond.iter().filter(|own| **own).count().checked_sub(1).filter(|own| *own < 4);
    let curves = located(
        (0.1 * PI / contact).min(scale.duration / 200.0),
        [tooth, speed, height, height * contact],
        |p| [0.0, p[0], 0.0, 0.0],
        move |p, y, sides| {
            let [_, back, height, stiffness, press, pawl, damper] = p[..7] else { unreachable!() };
            let [rises, slope] = piece(&sides[..5]).map_or([0.0; 2], |piece| rack(y[0], height)[piece]);
            let push = if sides[5] { stiffness * (rises - y[2]) } else { 0.0 };
            [y[1], -back * y[0] - push * slope, y[3], (push - press * (y[2] + tooth) - damper * y[3]) / pawl]
        },
        move |p, y| {
            let beyond = corners.map(|corner| y[0] - corner);
            let rises = piece(&beyond.map(|own| own > 0.0)).map_or(0.0, |piece| rack(y[0], p[2])[piece][0]);
            let [a, b, c, d, e] = beyond;
            [a, b, c, d, e, rises - y[2]]
        },
        |y| [y[0], y[1], y[2]],
    );
    let [a, b, c, d, e] = corners.map(|corner| format!("s{place}.x - {corner:?}"));
    let (up, down) = (format!("h{place}/{:?}", tooth - steep), format!("h{place}/{steep:?}"));
    let profile = format!("max(max(0, min({up}*({a}), -{down}*({c}))), min({up}*({c}), -{down}*({e})))");
    let slope =
        format!("if({a} > 0, if({b} > 0, if({c} > 0, if({d} > 0, if({e} > 0, 0, -{down}), {up}), -{down}), {up}), 0)");
    let push = format!("K{place}*max({profile} - p{place}.y, 0)");
    let slide =
        format!("f{place}: {{ force: {{ on: s{place}, value: [\"-k{place}*s{place}.x - {push}*({slope})\", 0] }} }}");
    let held = format!(
        "g{place}: {{ force: {{ on: p{place}, value: [0, \"{push} - q{place}*(p{place}.y + {tooth:?}) - z{place}*p{place}.vy\"] }} }}"
    );
    Term {
        parameters: vec![
            parameter("v", place, speed, 0.1),
            parameter("k", place, back, 0.2),
            parameter("h", place, height, 0.1),
            parameter("K", place, stiffness, 0.2),
            parameter("q", place, press, 0.2),
            parameter("m", place, pawl, 0.1),
            parameter("z", place, damper, 0.1),
        ],
        bodies: lines(&["s#: { mass: 1, coordinates: [x] }", "p#: { mass: m#, coordinates: [y] }"], place),
        joints: vec![],
        effects: vec![slide, held],
        initial: lines(&["s#.x: 0", "s#.vx: v#", "p#.y: 0", "p#.vy: 0"], place),
        guess: vec![],
        channels: lines(&["s#.x", "s#.vx", "p#.y"], place),
        curves,
        integrated: true,
        size: 3.0 * tooth,
        spatial: false,
        hidden: None,
    }
}

/// A pin that a force turns about within a hollow that is a little wider, with gravity.
pub fn clearance(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let clearance = digits(random.scale(1e-5, 1e-3), 2);
    let radius = digits(random.scale(2.0, 20.0) * clearance, 2);
    // Number of crossings in the duration.
    let crossings = random.between(0.6, 6.0);
    let speed = 2.0 * clearance * crossings / scale.duration;
    let direction = random.between(0.0, TAU);
    let [right, up] = [direction.cos(), direction.sin()].map(|share| digits(speed * share, 3));
    let weight = digits(speed * speed / clearance * random.scale(0.02, 0.5), 3);
    let contact = random.scale(0.003, 0.1) * scale.duration;
    let stiffness = digits((PI / contact).powi(2), 3);
    let dissipation = if random.chance(0.5) { digits(random.between(0.05, 0.5) / speed, 2) } else { 0.0 };
    // As the law has it: rounded in the middle, which has no direction.
    let off = |y: &[f64; 4], clearance: f64| (y[0] * y[0] + y[1] * y[1] + 1e-8 * clearance * clearance).sqrt();
    let curves = located(
        (0.2 * contact).min(scale.duration / 200.0),
        [clearance, clearance, speed, speed],
        |p| [0.0, 0.0, p[0], p[1]],
        move |p, y, sides| {
            let [_, _, _, stiffness, weight, dissipation] = p[..6] else { unreachable!() };
            let off = off(y, p[2]);
            let rate = (y[0] * y[2] + y[1] * y[3]) / off;
            let share = if sides[1] { 1.0 + dissipation * rate } else { 0.0 };
            let push = if sides[0] { stiffness * (off - p[2]) * share } else { 0.0 };
            [y[2], y[3], -push * y[0] / off, -push * y[1] / off - weight]
        },
        move |p, y| {
            let off = off(y, p[2]);
            let rate = (y[0] * y[2] + y[1] * y[3]) / off;
            [off - p[2], 1.0 + p[5] * rate]
        },
        |y| [y[0], y[1], y[3]],
    );
    let bearing = format!(
        "f{place}: {{ contact: {{ between: [ground, b{place}], hollow: \"{radius:?} + c{place}\", radius: {radius:?}, \
         impact: {{ stiffness: K{place}, exponent: 1, dissipation: d{place} }} }} }}"
    );
    Term {
        parameters: vec![
            parameter("u", place, right, 0.1),
            parameter("v", place, up, 0.1),
            parameter("c", place, clearance, 0.1),
            parameter("K", place, stiffness, 0.2),
            parameter("w", place, weight, 0.1),
            parameter("d", place, dissipation, 0.2),
        ],
        bodies: vec![named("b#: { mass: 1, coordinates: [x, y] }", place)],
        joints: vec![],
        effects: vec![named("g#: { force: { on: b#, value: [0, \"-w#\"] } }", place), bearing],
        initial: lines(&["b#.x: 0", "b#.y: 0", "b#.vx: u#", "b#.vy: v#"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.y", "b#.vy"], place),
        curves,
        integrated: true,
        size: clearance,
        spatial: false,
        hidden: None,
    }
}
