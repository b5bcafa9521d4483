//! Sines of a band of frequencies, and their mixtures with amplitudes that add up to 1 at most.
//!
//! For functions that are straight between values vₖ at the ends of cells the functional is Σ wₖ vₖ. Its largest value
//! over the mixtures is that of one sine, max |Σ wₖ exp(iωtₖ)| over the band, since a linear functional of a convex set
//! is largest at an extreme point of it.

use std::f64::consts::TAU;

use symdiff::math;

use super::rate::by_values;
use super::tuning::TUNING;
use super::{Cell, along, begin, length};

/// Share of an interval that remains by a golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Σ wₖ exp(iωtₖ), its real and its imaginary part.
fn transform(weights: &[(f64, f64)], frequency: f64) -> [f64; 2] {
    let turn = TAU * frequency;
    weights.iter().fold([0.0; 2], |[real, imaginary], (time, weight)| {
        let (sine, cosine) = (math::sin(turn * time), math::cos(turn * time));
        [real + weight * cosine, imaginary + weight * sine]
    })
}

/// The best sine of a band, Hz, over cells that end at these times, and its frequency.
pub fn worst_sine([least, most]: [f64; 2], ends: &[f64], functional: &[Cell]) -> (Vec<Cell>, f64) {
    let times = (0..=ends.len()).map(|number| begin(ends, number));
    let weights: Vec<(f64, f64)> =
        times.zip(by_values(ends, functional)).filter(|(_, weight)| *weight != 0.0).collect();
    let size = |frequency: f64| {
        let [real, imaginary] = transform(&weights, frequency);
        real * real + imaginary * imaginary
    };
    let last = weights.last().map_or(0.0, |(time, _)| *time);
    let count = ((most - least) * last * TUNING.tried_frequencies).ceil();
    let step = if count > 0.0 { (most - least) / count } else { 0.0 };
    let mut best = (size(least), least);
    for number in 1..=count as usize {
        let frequency = (least + number as f64 * step).min(most);
        let own = size(frequency);
        if own > best.0 {
            best = (own, frequency);
        }
    }
    let [mut from, mut to] = [(best.1 - step).max(least), (best.1 + step).min(most)];
    for _ in 0..TUNING.divisions {
        let (a, b) = (to - GOLDEN * (to - from), from + GOLDEN * (to - from));
        let [at_a, at_b] = [size(a), size(b)];
        for (own, frequency) in [(at_a, a), (at_b, b)] {
            if own > best.0 {
                best = (own, frequency);
            }
        }
        if at_a > at_b { to = b } else { from = a }
    }
    let frequency = best.1;
    let [real, imaginary] = transform(&weights, frequency);
    let phase = math::atan2(imaginary, real);
    let value = |number: usize| math::cos(TAU * frequency * begin(ends, number) - phase);
    (along(ends, value), frequency)
}

/// Share that chords of a sine of this frequency lie below it, ω² d²/12 on average, of the longest cell.
pub fn share_of_chords(frequency: f64, ends: &[f64]) -> f64 {
    let longest = (0..ends.len()).map(|cell| length(ends, cell)).fold(0.0, f64::max);
    (TAU * frequency * longest).powi(2) / 12.0
}
