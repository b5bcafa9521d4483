//! Oscillators under a pulse of force that may be shorter than a step, by Duhamel's integral.

use std::f64::consts::TAU;

use super::oscillators::decay;
use super::{Scale, closed_form, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;

/// Shape of a pulse: formula of time with centre `T#` and half width `D#`, value at s = (t − T)/D, and the kinks of the
/// value.
struct Shape {
    formula: &'static str,
    value: fn(f64) -> f64,
    /// Ascending; beyond the first and last it is 0.
    kinks: &'static [f64],
    /// Integral over s.
    area: f64,
}

const SHAPES: [Shape; 4] = [
    Shape {
        formula: "exp(-((t - T#)/D#)^2)",
        value: |s| (-s * s).exp(),
        kinks: &[-6.0, -3.0, -1.0, 0.0, 1.0, 3.0, 6.0],
        area: 1.772_453_850_905_516,
    },
    Shape { formula: "max(0, 1 - ((t - T#)/D#)^2)", value: |s| 1.0 - s * s, kinks: &[-1.0, 0.0, 1.0], area: 4.0 / 3.0 },
    Shape { formula: "max(0, 1 - abs(t - T#)/D#)", value: |s| 1.0 - s.abs(), kinks: &[-1.0, 0.0, 1.0], area: 1.0 },
    Shape {
        formula: "0.5*(sign(t - T# + D#) - sign(t - T# - D#))",
        value: |_| 1.0,
        kinks: &[-1.0, 0.0, 1.0],
        area: 2.0,
    },
];

/// Gauss and Legendre's eight nodes and weights on [−1, 1] (Abramowitz & Stegun, table 25.4): the positive ones.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// ∫ f from a to b.
pub fn integral(a: f64, b: f64, panels: usize, f: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let half = 0.5 * (b - a) / panels as f64;
    let mut total = [0.0; 2];
    for panel in 0..panels {
        let middle = a + (2 * panel + 1) as f64 * half;
        for [node, weight] in GAUSS {
            for sign in [-1.0, 1.0] {
                let value = f(middle + sign * node * half);
                total = [total[0] + weight * half * value[0], total[1] + weight * half * value[1]];
            }
        }
    }
    total
}

pub fn pulse(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let turns = random.scale(0.3, 5.0);
    let omega = (turns * TAU / scale.duration).min(0.2 / scale.step);
    let m = random.scale(0.1, 10.0);
    let k = crate::random::digits(m * omega * omega, 3);
    let damping = random.pick(&[0.0, 0.02, 0.2]);
    let c = crate::random::digits(2.0 * damping * m * omega, 3);
    let x = random.scale(1e-2, 1.0);
    let which = random.whole(0, SHAPES.len() - 1);
    let shape = &SHAPES[which];
    let half = random.scale(5e-3, 50.0) * scale.step;
    let half = crate::random::digits(half.min(0.1 * scale.duration), 3);
    let centre = random.between(0.05, 0.9) * scale.duration;
    // Strong enough to change the motion by about its own size.
    let impulse = m * omega * x * random.scale(0.1, 3.0);
    let strength = crate::random::digits(impulse / (half * shape.area), 3);
    let parameters = vec![
        parameter("m", place, m, 0.1),
        parameter("k", place, k, 0.2),
        removable("c", place, c, 0.5),
        removable("x", place, x, 0.2),
        parameter("F", place, strength, 0.3),
        parameter("T", place, crate::random::digits(centre, 5), 0.05),
        parameter("D", place, half, 0.3),
    ];
    let force = named("-k#*b#.x - c#*b#.vx + F#*", place) + &named(shape.formula, place);
    let curves = closed_form(move |p, t| {
        let shape = &SHAPES[which];
        let [m, k, c, x, v, strength, centre, half] = [p[0], p[1], p[2], p[3], 0.0, p[4], p[5], p[6]];
        let (square, delta) = (k / m, c / (2.0 * m));
        let mut state = decay(square, delta, x, v, t);
        for ends in shape.kinks.windows(2) {
            let [from, to] = [ends[0], ends[1]].map(|s| (centre + s * half).clamp(0.0, t));
            if to > from {
                // State at t by the impulse at `at`, per unit of time.
                let response = |at: f64| {
                    let force = strength / m * (shape.value)((at - centre) / half);
                    decay(square, delta, 0.0, force, t - at)
                };
                let more = integral(from, to, 4, response);
                state = [state[0] + more[0], state[1] + more[1]];
            }
        }
        state
    });
    Term {
        parameters,
        bodies: vec![named("b#: { mass: m#, coordinates: [x] }", place)],
        joints: vec![],
        effects: vec![format!("s{place}: {{ force: {{ on: b{place}, value: [\"{force}\", 0] }} }}")],
        initial: lines(&["b#.x: x#", "b#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves,
        integrated: false,
        size: x,
        spatial: false,
        hidden: None,
    }
}
