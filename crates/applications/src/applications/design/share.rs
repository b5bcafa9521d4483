//! Slacks that a share of the production leaves, as a function of the nominal values.

use super::goal::Goal;
use super::surface::DesignSurface;
use super::tuning::TUNING;
use super::worst::{Assessed, around, quotients};
use crate::applications::allocate::tuning::TUNING as ALLOCATE;
use crate::numerics::statistics::{Mixture, weighted_quantile};
use crate::numerics::{Linear, PointSet};
use crate::study::statistics::Laws;

/// Slacks in a share of the samples of the parameters' laws, which move with the nominal values.
pub struct Yield<'s> {
    surface: &'s DesignSurface,
    goal: Goal,
    /// Values of the uncertain parameters, about a point.
    values: PointSet,
    weights: Vec<f64>,
    from: Vec<f64>,
    may_fail: f64,
}

impl<'s> Yield<'s> {
    /// The yield under these laws about a point.
    pub fn new(surface: &'s DesignSurface, goal: Goal, laws: &Laws, from: &[f64], share: f64) -> Self {
        let (points, weights) = Mixture::default().replicate(0, laws.dimension(), TUNING.samples_of_share);
        Self { surface, goal, values: laws.of_scores(&points), weights, from: from.to_vec(), may_fail: 1.0 - share }
    }

    /// Requirements that are to be fulfilled together.
    fn groups(&self) -> Vec<Vec<usize>> {
        let count = self.surface.count();
        match self.goal {
            Goal::Margin | Goal::Cost(_) => vec![(0..count).collect()],
            Goal::Last => vec![(0..count - 1).collect(), vec![count - 1]],
        }
    }

    /// Least slack of a group of requirements for each sample, about a point.
    fn least(&self, point: &[f64], group: &[usize], samples: &[usize]) -> Vec<f64> {
        let values = self.values.points();
        let moved: Vec<Vec<f64>> =
            samples.iter().map(|&own| self.surface.axes.moved(values.point(own), &self.from, point)).collect();
        let slacks = self.surface.slacks(&moved);
        let least =
            |sample: usize| group.iter().map(|own| slacks[own * moved.len() + sample]).fold(f64::INFINITY, f64::min);
        (0..moved.len()).map(least).collect()
    }

    /// Samples about the quantile of some values.
    fn beside(&self, values: &[f64]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
        let index = |times: f64| ((times * self.may_fail * values.len() as f64) as usize).min(values.len());
        let (from, to) = (index(ALLOCATE.beside_quantile[0]), index(ALLOCATE.beside_quantile[1]));
        if to < from + ALLOCATE.fewest_beside {
            order[..ALLOCATE.fewest_beside].to_vec()
        } else {
            order[from..to].to_vec()
        }
    }
}

impl Assessed for Yield<'_> {
    fn slacks(&mut self, point: &[f64]) -> Vec<f64> {
        let mut slacks = vec![f64::INFINITY; self.surface.count()];
        let all: Vec<usize> = (0..self.weights.len()).collect();
        for group in self.groups() {
            let quantile = weighted_quantile(&self.least(point, &group, &all), &self.weights, self.may_fail);
            group.into_iter().for_each(|own| slacks[own] = quantile);
        }
        slacks
    }

    fn count(&self) -> usize {
        self.surface.count()
    }

    fn has_learnt(&self) -> bool {
        false
    }

    fn linearised(&mut self, point: &[f64]) -> Vec<(usize, Linear)> {
        let all: Vec<usize> = (0..self.weights.len()).collect();
        let points = around(self.surface, point);
        let of_group = |group: Vec<usize>| {
            let first = *group.first()?;
            let values = self.least(point, &group, &all);
            let beside = self.beside(&values);
            let mean = |own: &Vec<f64>| self.least(own, &group, &beside).iter().sum::<f64>() / beside.len() as f64;
            let slopes = quotients(&points.iter().map(mean).collect::<Vec<_>>(), &points).slopes;
            Some((first, Linear { value: weighted_quantile(&values, &self.weights, self.may_fail), slopes }))
        };
        self.groups().into_iter().filter_map(of_group).collect()
    }
}
