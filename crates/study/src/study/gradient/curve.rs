//! An output over the time, as its rows have it: between them it is the cubic through the four nearest.

use super::tuning::TUNING;
use crate::numerics::{bisected, row_weights};
use crate::simulate::Term;

/// A course over the rows; scaled by a sign.
#[derive(Clone, Copy)]
pub(super) struct Curve<'a> {
    pub times: &'a [f64],
    /// By row.
    pub values: &'a [f64],
    /// Number of the output.
    pub output: usize,
    /// 1 or −1.
    pub sign: f64,
}

impl Curve<'_> {
    /// Value at an instant.
    pub fn value(&self, time: f64) -> f64 {
        self.weights(time).map(|(row, weight)| self.sign * weight * self.values[row]).sum()
    }

    /// Derivatives of the value at a fixed instant by the rows.
    pub fn terms(&self, time: f64) -> impl Iterator<Item = Term> + use<'_> {
        self.weights(time).map(|(row, weight)| Term { row, output: self.output, weight: self.sign * weight })
    }

    /// Rates of change: of the value, and of that.
    pub fn rates(&self, time: f64) -> [f64; 2] {
        let step = 1e-3 * self.spacing();
        // Within the cubic that holds on both sides.
        let middle = time.clamp(self.times[0] + step, self.times[self.times.len() - 1] - step);
        let [before, here, after] = [-step, 0.0, step].map(|shift| self.value(middle + shift));
        [(after - before) / (2.0 * step), (after - 2.0 * here + before) / (step * step)]
    }

    fn spacing(&self) -> f64 {
        match self.times {
            [first, .., last] => (last - first) / (self.times.len() - 1) as f64,
            _ => 1.0,
        }
    }

    /// Rows and their weights at an instant (Lagrange).
    fn weights(&self, time: f64) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let next = self.times.partition_point(|&row| row <= time).max(1);
        row_weights(self.times, time, next, 4)
    }

    /// The ends of a span, and the rows between them.
    fn instants(&self, from: f64, to: f64) -> Vec<f64> {
        let rows = self.times.iter().copied().filter(|time| from < *time && *time < to);
        std::iter::once(from).chain(rows).chain([to]).collect()
    }

    /// When it is greatest from one instant to another.
    pub fn highest(&self, from: f64, to: f64) -> f64 {
        let best = self
            .instants(from, to)
            .into_iter()
            .max_by(|a, b| self.value(*a).total_cmp(&self.value(*b)))
            .unwrap_or(from);
        let (mut low, mut high) = ((best - self.spacing()).max(from), (best + self.spacing()).min(to));
        let share = 0.5 * (5.0_f64.sqrt() - 1.0);
        for _ in 0..TUNING.halvings {
            let [left, right] = [high - share * (high - low), low + share * (high - low)];
            if self.value(left) < self.value(right) { low = left } else { high = right }
        }
        let found = 0.5 * (low + high);
        if self.value(found) > self.value(best) { found } else { best }
    }

    /// The first and the last instant of a span at which it changes its sign, and whether it is not negative at the
    /// span's ends.
    pub fn changes(&self, from: f64, to: f64) -> ([Option<f64>; 2], [bool; 2]) {
        let instants = self.instants(from, to);
        let is_met = |time: f64| self.value(time) >= 0.0;
        let mut pairs = instants.windows(2).filter(|pair| is_met(pair[0]) != is_met(pair[1]));
        let zero = |pair: &[f64]| {
            let begins = is_met(pair[0]);
            bisected(pair[0], pair[1], TUNING.halvings, |time| is_met(time) != begins)
        };
        let first = pairs.next();
        let last = pairs.next_back().or(first);
        ([first, last].map(|pair| pair.map(zero)), [from, to].map(is_met))
    }

    /// ∫ f(value) dt by Simpson's rule, with a value between each two rows, and its derivatives by the rows; `of` has f
    /// and f′.
    pub fn integral(&self, from: f64, to: f64, of: impl Fn(f64) -> [f64; 2]) -> (f64, Vec<Term>) {
        let mut sum = 0.0;
        let mut by_rows = vec![0.0; self.times.len()];
        for pair in self.instants(from, to).windows(2) {
            let length = pair[1] - pair[0];
            for (time, share) in [(pair[0], 1.0), (0.5 * (pair[0] + pair[1]), 4.0), (pair[1], 1.0)] {
                let ([value, slope], share) = (of(self.value(time)), share / 6.0 * length);
                sum += share * value;
                self.terms(time).for_each(|term| by_rows[term.row] += share * slope * term.weight);
            }
        }
        let term = |(row, weight)| Term { row, output: self.output, weight };
        (sum, by_rows.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0).map(term).collect())
    }
}
