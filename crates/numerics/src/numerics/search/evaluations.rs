//! All values that a search has seen, and results from them.

use std::collections::hash_map::Entry;

use rustc_hash::FxHashMap;

use super::Extremes;
use super::tuning::TUNING;
use crate::numerics::extremes::ValuesAt;
use crate::numerics::range::Range;

/// The largest value of a function (sign 1), or of its negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Goal {
    pub(super) output: usize,
    pub(super) sign: f64,
}

/// All that was evaluated.
#[derive(Default)]
pub(super) struct Evaluations {
    pub(super) points: Vec<Vec<f64>>,
    /// Values of each function, in the order of the points.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) indices: FxHashMap<Vec<u64>, usize>,
}

/// Key of a point: the bits of its coordinates.
pub(super) fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|xi| (xi + 0.0).to_bits()).collect() // −0 is 0
}

impl Evaluations {
    /// Evaluates new points; returns the indices of all.
    pub(super) fn look(&mut self, wanted: Vec<Vec<f64>>, evaluate: &ValuesAt) -> Vec<usize> {
        let first = self.points.len();
        let mut indices = Vec::with_capacity(wanted.len());
        for point in wanted {
            indices.push(match self.indices.entry(bits(&point)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    self.points.push(point);
                    *new.insert(self.points.len() - 1)
                }
            });
        }
        let new = &self.points[first..];
        if !new.is_empty() {
            let values = evaluate(new);
            for (line, values) in self.values.iter_mut().zip(values.chunks_exact(new.len())) {
                line.extend_from_slice(values);
            }
        }
        indices
    }

    /// Value that a goal maximises; NaN is the least of all.
    pub(super) fn value(&self, goal: Goal, index: usize) -> f64 {
        let value = goal.sign * self.values[goal.output][index];
        if value.is_nan() { f64::NEG_INFINITY } else { value }
    }

    pub(super) fn width(&self, goal: Goal) -> f64 {
        let finite = self.values[goal.output].iter().copied().filter(|value| value.is_finite());
        let (lower, upper) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)));
        (upper - lower).max(0.0)
    }

    /// Points to climb from: a neighbour's extreme, and the best points that are apart from it and from each other.
    pub(super) fn starts(&self, goal: Goal, neighbour: Option<usize>) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by(|&a, &b| self.value(goal, b).total_cmp(&self.value(goal, a)));
        let enough = match neighbour {
            Some(_) => self.value(goal, order[0]) - TUNING.promising * self.width(goal),
            None => f64::NEG_INFINITY,
        };
        let most = if neighbour.is_some() { TUNING.starts.1 } else { TUNING.starts.0 };
        let mut starts: Vec<usize> = neighbour.into_iter().collect();
        let promising = order.into_iter().take_while(|&place| self.value(goal, place) >= enough);
        self.spread(promising, most, &mut starts);
        starts
    }

    /// Adds points that are apart from all before them, up to `most`.
    fn spread(&self, indices: impl Iterator<Item = usize>, most: usize, chosen: &mut Vec<usize>) {
        for index in indices {
            let apart = |&other: &usize| {
                self.points[other].iter().zip(&self.points[index]).any(|(a, b)| (a - b).abs() > TUNING.starts_apart)
            };
            if chosen.len() < most && chosen.iter().all(apart) {
                chosen.push(index);
            }
        }
    }

    pub(super) fn best_value(&self, goal: Goal) -> f64 {
        (0..self.points.len()).map(|place| self.value(goal, place)).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(super) fn extremes(&self, output: usize, ends: &[(Goal, usize)]) -> Extremes {
        let best = |sign| {
            let goal = Goal { output, sign };
            let better = |best, index| if self.value(goal, index) > self.value(goal, best) { index } else { best };
            (0..self.points.len()).fold(0, better)
        };
        let (lowest, highest) = (best(-1.0), best(1.0));
        let values = &self.values[output];
        let known = !values.iter().any(|value| value.is_nan());
        let range = if known { Range { lower: values[lowest], upper: values[highest] } } else { Range::UNKNOWN };
        let others = [(1.0, highest), (-1.0, lowest)].into_iter().flat_map(|(sign, best)| {
            let goal = Goal { output, sign };
            let mut order: Vec<usize> = ends.iter().filter(|end| end.0 == goal).map(|end| end.1).collect();
            order.sort_by(|&a, &b| self.value(goal, b).total_cmp(&self.value(goal, a)));
            let mut others = vec![best];
            self.spread(order.into_iter(), TUNING.others + 1, &mut others);
            others.into_iter().skip(1)
        });
        let others = others.map(|index| self.points[index].clone()).collect();
        Extremes { range, lowest: self.points[lowest].clone(), highest: self.points[highest].clone(), others }
    }
}
