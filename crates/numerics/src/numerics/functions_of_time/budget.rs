//! Functions whose mean or energy over the whole time is limited.
//!
//! Over cells of length dₖ with levels aₖ the functional is Σ gₖ aₖ.
//!
//! - *Mean*, |u| ≤ 1 and Σ aₖ dₖ in an interval: aₖ = sign(gₖ/dₖ − μ), where μ, the multiplier of the mean, is zero
//!   unless an end of the interval is reached; one cell may be in between (the fractional knapsack).
//! - *Energy*, Σ aₖ² dₖ ≤ E: aₖ = λ gₖ/dₖ by Cauchy and Schwarz's inequality, cut off at 1 if |u| ≤ 1 too.

use super::tuning::TUNING;
use super::{Cell, length, sign};

fn lengths(ends: &[f64]) -> Vec<f64> {
    (0..ends.len()).map(|cell| length(ends, cell)).collect()
}

/// The best function between −1 and 1 whose mean lies between two, and the multiplier μ.
pub fn with_mean([least, most]: [f64; 2], ends: &[f64], functional: &[Cell]) -> (Vec<Cell>, f64) {
    let lengths = lengths(ends);
    let duration: f64 = lengths.iter().sum();
    let signs = || functional.iter().map(|[level, _]| sign(*level));
    let sum: f64 = signs().zip(&lengths).map(|(sign, length)| sign * length).sum();
    let free: f64 = signs().zip(&lengths).filter(|(sign, _)| *sign == 0.0).map(|(_, length)| length).sum();
    let (least, most) = (least * duration, most * duration);
    if sum - free <= most && sum + free >= least {
        // Where the functional is zero, levels are free: these make up the mean.
        let level = if free > 0.0 { (0.0_f64.clamp(least - sum, most - sum) / free).clamp(-1.0, 1.0) } else { 0.0 };
        let function = signs().map(|sign| [if sign == 0.0 { level } else { sign }, 0.0]).collect();
        return (function, 0.0);
    }
    // Cells in the order in which they change their sign as μ grows from zero, upwards or downwards.
    let direction = if sum - free > most { 1.0 } else { -1.0 };
    let density = |cell: usize| direction * functional[cell][0] / lengths[cell];
    let mut levels: Vec<f64> = signs().map(|sign| if sign == 0.0 { -direction } else { sign }).collect();
    let mut turning: Vec<usize> = (0..lengths.len()).filter(|&cell| density(cell) > 0.0).collect();
    turning.sort_by(|a, b| density(*a).total_cmp(&density(*b)).then(a.cmp(b)));
    let mut excess = if direction > 0.0 { sum - free - most } else { least - sum - free };
    let mut multiplier = 0.0;
    for cell in turning {
        if excess <= 0.0 {
            break;
        }
        let turned = excess.min(2.0 * lengths[cell]);
        levels[cell] -= direction * turned / lengths[cell];
        excess -= turned;
        multiplier = direction * density(cell);
    }
    (levels.into_iter().map(|level| [level, 0.0]).collect(), multiplier)
}

/// The best function of at most this energy (s), and the factor λ; `bounded` ones are between −1 and 1 too.
pub fn with_energy(energy: f64, bounded: bool, ends: &[f64], functional: &[Cell]) -> (Vec<Cell>, f64) {
    let lengths = lengths(ends);
    let density: Vec<f64> = functional.iter().zip(&lengths).map(|([level, _], length)| level / length).collect();
    let mut order: Vec<usize> = (0..density.len()).filter(|&cell| density[cell] != 0.0).collect();
    order.sort_by(|a, b| density[*b].abs().total_cmp(&density[*a].abs()).then(a.cmp(b)));
    let square = |cell: usize| density[cell] * density[cell] * lengths[cell];
    let mut rests: Vec<f64> = order.iter().map(|&cell| square(cell)).collect();
    (1..rests.len()).rev().for_each(|number| rests[number - 1] += rests[number]);
    // The strongest cells are at their limit, as many as necessary.
    let (mut spent, mut factor) = (0.0, f64::INFINITY);
    for (&cell, rest) in order.iter().zip(rests) {
        let own = ((energy - spent) / rest).sqrt();
        if !bounded || own * density[cell].abs() <= 1.0 {
            factor = own;
            break;
        }
        spent += lengths[cell];
    }
    let most = if bounded { 1.0 } else { f64::INFINITY };
    let level = |density: &f64| if *density == 0.0 { 0.0 } else { (factor * density).clamp(-most, most) };
    let function = density.iter().map(|density| [level(density), 0.0]).collect();
    (function, factor)
}

/// Cost of cells where not all of them are at their limit: λ s² d³/24 of a kernel that is straight in one with a
/// slope s. Where the kernel ends, steps smear it over a cell, of which halved steps show five sixths. `factor` is λ.
pub fn loss_by_energy(factor: f64, ends: &[f64], functional: &[Cell], function: &[Cell]) -> f64 {
    let lengths = lengths(ends);
    let density = |cell: usize| (functional[cell][0] / lengths[cell]).abs();
    // Cost of an end of the kernel with the cells before `end`.
    let of_end = |end: usize| {
        let before = end.saturating_sub(2)..end;
        let whole = before.clone().map(density).fold(0.0, f64::max);
        let level = before.map(|cell| function[cell][0].abs()).fold(0.0, f64::max);
        TUNING.smeared * level * whole * lengths[end - 1]
    };
    let loss = |cell: usize| {
        let [before, after] = [cell - 1, cell].map(|cell| functional[cell][0] / lengths[cell]);
        if after == 0.0 {
            return of_end(cell);
        }
        let slope = (after - before) / (0.5 * (lengths[cell] + lengths[cell - 1]));
        factor * slope * slope * lengths[cell].max(lengths[cell - 1]).powi(3) / 24.0
    };
    let inner = (1..lengths.len()).filter(|&cell| function[cell][0].abs() < 1.0 || function[cell - 1][0].abs() < 1.0);
    inner.map(loss).sum::<f64>() + if lengths.is_empty() { 0.0 } else { of_end(lengths.len()) }
}
