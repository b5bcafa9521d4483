//! Functions with a bounded rate from 0 on, and those between limits with a bounded rate.
//!
//! For the latter, values u₀ … u_N at the ends of cells form a chain with |uₖ − uₖ₋₁| ≤ ρ dₖ, whose best is found by
//! dynamic programming (Bellman's principle). The best value of the first cells as a function of uₖ is concave and
//! piecewise linear: its breakpoints move apart by ρ dₖ, a linear term moves some of them over the maximum, and limits
//! cut off those beyond; each a few times in all.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Cell, along, begin, sign, straight};

/// The functional's coefficients in terms of slopes.
pub fn by_slopes(ends: &[f64], functional: &[Cell]) -> Vec<f64> {
    let mut slopes = vec![0.0; functional.len()];
    let mut levels_after = 0.0;
    for (cell, [level, slope]) in functional.iter().enumerate().rev() {
        let begin = begin(ends, cell);
        slopes[cell] = slope - level * begin + (ends[cell] - begin) * levels_after;
        levels_after += level;
    }
    slopes
}

/// The functional's coefficients of the values at the ends of cells, of functions that are straight between them; the
/// first is that of the value at the beginning.
pub fn by_values(ends: &[f64], functional: &[Cell]) -> Vec<f64> {
    let mut by_values = vec![0.0; ends.len() + 1];
    for (cell, [level, slope]) in functional.iter().enumerate() {
        let begin = begin(ends, cell);
        let by_slope = (slope - level * begin) / (ends[cell] - begin);
        by_values[cell] += level - by_slope;
        by_values[cell + 1] += by_slope;
    }
    by_values
}

/// The best function from 0 on whose rate is at most 1, by the functional's coefficients in terms of slopes.
pub fn from_zero(ends: &[f64], slopes: &[f64]) -> Vec<Cell> {
    let mut from = 0.0;
    let of_cell = |(cell, slope): (usize, &f64)| {
        let to = from + sign(*slope) * (ends[cell] - begin(ends, cell));
        let own = straight(ends, cell, from, to);
        from = to;
        own
    };
    slopes.iter().enumerate().map(of_cell).collect()
}

/// Breakpoints of a concave function on one side of its maximum, the nearest to it first: how far out they are before
/// `shift` is added, and by how much the slope changes there. Beyond the last one is a limit.
struct Side {
    points: VecDeque<(f64, f64)>,
    shift: f64,
    /// Distance of the limit.
    limit: f64,
}

impl Side {
    fn new(limit: f64) -> Self {
        Self { points: VecDeque::new(), shift: 0.0, limit }
    }

    /// The outer end of the interval on which the function is largest.
    fn nearest(&self) -> f64 {
        self.points.front().map_or(self.limit, |(point, _)| (point + self.shift).min(self.limit))
    }

    /// Moves the maximum outwards, until slopes have changed by so much: points that it passes go to the other side.
    fn climb(&mut self, mut slope: f64, other: &mut Self) {
        while slope > 0.0 {
            let (point, change) = match self.points.pop_front() {
                Some((point, change)) if point + self.shift < self.limit => (point + self.shift, change),
                // All others are beyond the limit too.
                _ => {
                    self.points.clear();
                    other.points.push_front((-self.limit - other.shift, slope));
                    return;
                }
            };
            let passed = change.min(slope);
            other.points.push_front((-point - other.shift, passed));
            if change > slope {
                self.points.push_front((point - self.shift, change - slope));
            }
            slope -= passed;
        }
    }

    /// Cuts off the part beyond a limit of the other side, `least` outwards: the function rises there at once.
    fn cut(&mut self, least: f64) {
        let mut rise = 0.0;
        while let Some(&(_, change)) = self.points.front().filter(|(point, _)| point + self.shift < least) {
            self.points.pop_front();
            rise += change;
        }
        if rise > 0.0 {
            self.points.push_front((least - self.shift, rise));
        }
    }
}

/// Limits at the ends of cells, at 0 those of the beginning: their middle and half of their distance. A function u
/// between −1 and 1 is x = middle + reach · u between them.
pub trait Limits {
    /// Limits at the end of the cell before this number.
    fn at(&self, number: usize) -> [f64; 2];
}

/// Limits of u itself.
pub struct Still;

impl Limits for Still {
    fn at(&self, _: usize) -> [f64; 2] {
        [0.0, 1.0]
    }
}

impl Limits for Arc<[[f64; 2]]> {
    fn at(&self, number: usize) -> [f64; 2] {
        self[number]
    }
}

/// Limits of cells in pairs from the end.
pub struct EveryOther<'l, L> {
    /// Limits of all cells.
    pub limits: &'l L,
    /// Number of cells, 0 or 1, that are alone at the beginning.
    pub alone: usize,
}

impl<L: Limits> Limits for EveryOther<'_, L> {
    fn at(&self, number: usize) -> [f64; 2] {
        self.limits.at((2 * number).saturating_sub(self.alone))
    }
}

/// The best function u between −1 and 1 of which x changes at most at a rate. Limits change no faster.
pub fn between(rate: f64, limits: &impl Limits, ends: &[f64], functional: &[Cell]) -> Vec<Cell> {
    let by_values = by_values(ends, functional);
    let of_limits = |number: usize| {
        let [middle, reach] = limits.at(number);
        [middle - reach, middle + reach]
    };
    let [lower, upper] = of_limits(0);
    let (mut above, mut below) = (Side::new(upper), Side::new(-lower));
    // Values of x at which the value of the cells so far is largest.
    let mut largest = Vec::with_capacity(by_values.len());
    for (number, &by_value) in by_values.iter().enumerate() {
        if let Some(cell) = number.checked_sub(1) {
            let change = rate * (ends[cell] - begin(ends, cell));
            above.shift += change;
            below.shift += change;
            let [lower, upper] = of_limits(number);
            (above.limit, below.limit) = (upper, -lower);
            above.cut(lower);
            below.cut(-upper);
        }
        let [_, reach] = limits.at(number);
        // Where limits meet, u changes nothing.
        let slope = if reach > 0.0 { by_value / reach } else { 0.0 };
        if slope > 0.0 {
            above.climb(slope, &mut below);
        } else {
            below.climb(-slope, &mut above);
        }
        largest.push((-below.nearest(), above.nearest()));
    }
    let mut values = vec![0.0; by_values.len()];
    for number in (0..values.len()).rev() {
        let (from, to) = largest[number];
        values[number] = match ends.get(number) {
            None => 0.5 * (from + to),
            Some(end) => {
                let (next, change) = (values[number + 1], rate * (end - begin(ends, number)));
                next.max(from).min(to).clamp(next - change, next + change)
            }
        };
    }
    let of_value = |number: usize| {
        let [middle, reach] = limits.at(number);
        if reach > 0.0 { (values[number] - middle) / reach } else { 0.0 }
    };
    along(ends, of_value)
}
