//! Kinematics near change points: linkages that nearly have two ways on.

use std::f64::consts::TAU;

use super::{Scale, drives};
use crate::draw::Term;
use crate::random::{Random, digits};

/// A linkage that misses a change point by a ten-thousandth to a few hundredths.
pub fn change_point(random: &mut Random, scale: &Scale) -> Term {
    let gap = random.scale(1e-4, 3e-2);
    if random.chance(0.5) { slider_crank(random, scale, gap) } else { four_bar(random, scale, gap) }
}

/// In line, with a rod hardly longer than the crank: where the crank stands across, the slider nearly is at its centre.
fn slider_crank(random: &mut Random, scale: &Scale, gap: f64) -> Term {
    let mut term = drives::slider_crank(random, scale);
    let r = term.parameters[0].value;
    term.parameters[1].value = digits(r * (1.0 + gap), 8);
    term.parameters[2].value = 0.0;
    uncertain(random, scale, term, 1, r * gap)
}

/// Coupler and rocker together are hardly longer than base and crank: once a turn they are nearly stretched.
fn four_bar(random: &mut Random, scale: &Scale, gap: f64) -> Term {
    let mut term = drives::four_bar(random, scale);
    let base = term.parameters[0].value;
    let [r, l, s] = random.pick(&[[0.3, 0.7, 0.6], [0.333, 0.867, 0.466], [0.4, 0.8, 0.6]]);
    for (own, length) in term.parameters[1..4].iter_mut().zip([r, l * (1.0 + gap), s]) {
        own.value = digits(base * length, 8);
    }
    uncertain(random, scale, term, 2, base * l * gap)
}

/// One length may be off by less than leads to the change point; all else is certain.
fn uncertain(random: &mut Random, scale: &Scale, mut term: Term, which: usize, gap: f64) -> Term {
    term.parameters.iter_mut().for_each(|parameter| parameter.most = 0.0);
    term.parameters[which].half = digits(gap * random.scale(0.05, 0.8), 2);
    let speed = term.parameters.last_mut().expect("a driven linkage has a speed");
    speed.value = digits(random.scale(0.3, 4.0) * TAU / scale.duration, 3);
    term
}
