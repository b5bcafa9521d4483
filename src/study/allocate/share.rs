//! Yields: what the worst of most samples leaves, and how that changes with the tolerances.

use super::surface::Surface;
use super::worst::{STEP, Slack};
use crate::numerics::statistics::quantile_of;
use crate::numerics::{Linear, Power};

/// Samples from which the derivatives of the quantile are taken: the worst, so many times those that may fail, and at least so many. What the
/// tolerances take of them is shared as at the quantile itself where margins are linear and laws normal.
const BESIDE: f64 = 2.5;
const LEAST: usize = 64;

/// What a share of samples leaves of all requirements.
pub struct Share<'s> {
    pub surface: Surface<'s>,
    /// Samples of the model's own laws.
    samples: Vec<Vec<f64>>,
    /// The share of them that may fail.
    pub may_fail: f64,
}

impl<'s> Share<'s> {
    pub fn new(surface: Surface<'s>, samples: Vec<Vec<f64>>, may_fail: f64) -> Self {
        Self { surface, samples, may_fail }
    }

    /// Samples with these multiples of their distances from the nominal values.
    fn scaled<'a>(&'a self, multiples: &[f64], which: impl Iterator<Item = &'a Vec<f64>>) -> Vec<Vec<f64>> {
        let along = |sample: &Vec<f64>, axis: usize| {
            let nominal = self.surface.items[axis].nominal;
            nominal + multiples[axis] * (sample[axis] - nominal)
        };
        which.map(|sample| (0..multiples.len()).map(|axis| along(sample, axis)).collect()).collect()
    }

    /// What each sample leaves, by requirement.
    fn slacks(&self, multiples: &[f64]) -> Vec<f64> {
        self.surface.slacks(&self.scaled(multiples, self.samples.iter()))
    }

    /// What each sample leaves of the requirement of which it leaves least.
    fn worst(&self, slacks: &[f64]) -> Vec<f64> {
        let n = self.samples.len();
        let least =
            |sample: usize| (0..self.surface.count).map(|own| slacks[own * n + sample]).fold(f64::INFINITY, f64::min);
        (0..n).map(least).collect()
    }

    /// Numbers of the samples with the least of some values.
    fn beside(&self, values: &[f64]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
        let count = ((BESIDE * self.may_fail * values.len() as f64) as usize).max(LEAST);
        order.truncate(count);
        order
    }

    /// Mean derivatives of slacks of some samples with respect to the multiples; `pick` takes a sample's slack out of those of all.
    fn slopes(&self, multiples: &[f64], which: &[usize], pick: impl Fn(&[f64], usize) -> f64) -> Vec<f64> {
        let slope = |axis: usize| {
            let mean = |sign: f64| {
                let mut moved = multiples.to_vec();
                moved[axis] *= 1.0 + sign * STEP;
                let slacks = self.surface.slacks(&self.scaled(&moved, which.iter().map(|&place| &self.samples[place])));
                (0..which.len()).map(|place| pick(&slacks, place)).sum::<f64>() / which.len() as f64
            };
            (mean(1.0) - mean(-1.0)) / (2.0 * STEP * multiples[axis])
        };
        (0..multiples.len()).map(slope).collect()
    }
}

impl Slack for Share<'_> {
    /// The quantile of each requirement's own slack.
    fn left(&mut self, multiples: &[f64]) -> Vec<f64> {
        let mut slacks = self.slacks(multiples);
        slacks.chunks_exact_mut(self.samples.len()).map(|own| quantile_of(own, self.may_fail)).collect()
    }

    fn is_known_to_fail(&self, _: &[f64]) -> bool {
        false
    }

    fn linearised(&self, multiples: &[f64]) -> Vec<Linear> {
        let mut values = self.worst(&self.slacks(multiples));
        let beside = self.beside(&values);
        let (count, n) = (self.surface.count, beside.len());
        let pick =
            |slacks: &[f64], place: usize| (0..count).map(|own| slacks[own * n + place]).fold(f64::INFINITY, f64::min);
        let slopes = self.slopes(multiples, &beside, pick);
        // With respect to the squares.
        let slopes = slopes.iter().zip(multiples).map(|(slope, multiple)| slope / (2.0 * multiple)).collect();
        vec![Linear { value: quantile_of(&mut values, self.may_fail), slopes }]
    }

    fn power(&self) -> Power {
        Power::Second
    }

    fn slopes_at_least(&mut self, multiples: &[f64], requirement: usize) -> Vec<f64> {
        let n = self.samples.len();
        let beside = self.beside(&self.slacks(multiples)[requirement * n..][..n]);
        let count = beside.len();
        self.slopes(multiples, &beside, |slacks, place| slacks[requirement * count + place])
    }

    fn reserves(&mut self) -> &mut [f64] {
        &mut self.surface.reserves
    }

    fn allow(&mut self, may_fail: f64) {
        self.may_fail = may_fail;
    }

    /// The quantile of what all leave together.
    fn least(&mut self, multiples: &[f64]) -> f64 {
        quantile_of(&mut self.worst(&self.slacks(multiples)), self.may_fail)
    }
}
