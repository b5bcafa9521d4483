//! Yields: the margin that the worst of most samples leaves, and its change with the tolerances.

use super::surface::Surface;
use super::tuning::TUNING;
use super::worst::Slack;
use crate::numerics::statistics::{
    Mixture, REPLICATES, least_at_distance, normal_quantile, shares_below, weighted_quantile,
};
use crate::numerics::{Linear, PointSet, Power};
use crate::study::statistics::Laws;
use crate::study::statistics::tuning::TUNING as STATISTICS;

/// Remaining margin of all requirements in a share of samples.
pub struct Share<'s> {
    pub surface: Surface<'s>,
    laws: Laws,
    interrupted: &'s (dyn Fn() -> bool + Sync),
    /// The share of all that may fail.
    pub may_fail: f64,
    drawn: Option<Drawn>,
}

/// Samples of the model's own laws, with their weights.
struct Drawn {
    /// The multiples for which the samples were drawn.
    multiples: Vec<f64>,
    samples: PointSet,
    weights: Vec<f64>,
}

impl<'s> Share<'s> {
    pub fn new(surface: Surface<'s>, laws: Laws, interrupted: &'s (dyn Fn() -> bool + Sync), may_fail: f64) -> Self {
        Self { surface, laws, interrupted, may_fail, drawn: None }
    }

    /// Slacks, by requirement, of samples with these multiples of their distances from the nominal values.
    fn scaled<'p>(&self, multiples: &[f64], samples: impl ExactSizeIterator<Item = &'p [f64]>) -> Vec<f64> {
        let along = |sample: &[f64], axis: usize| {
            let nominal = self.surface.items[axis].nominal;
            nominal + multiples[axis] * (sample[axis] - nominal)
        };
        self.surface.slacks(PointSet::mapped(samples, multiples.len(), along).points())
    }

    /// Samples for these multiples, drawn again if those before were for others.
    fn draw(&mut self, multiples: &[f64]) -> &Drawn {
        let is_other = |(a, b): (&f64, &f64)| a / b > TUNING.redrawn || b / a > TUNING.redrawn;
        let drawn = match self.drawn.take() {
            Some(drawn) if !drawn.multiples.iter().zip(multiples).any(is_other) => drawn,
            _ => self.drawn_for(multiples),
        };
        self.drawn.insert(drawn)
    }

    fn drawn_for(&self, multiples: &[f64]) -> Drawn {
        let k = self.laws.dimension();
        let mixture = if self.may_fail < TUNING.rare { self.mixture(multiples) } else { Mixture::default() };
        let (mut scores, mut weights) = (Vec::new(), Vec::new());
        for number in 0..REPLICATES {
            let (points, own) = mixture.replicate(number, k, TUNING.points);
            scores.extend(points);
            weights.extend(own);
        }
        Drawn { multiples: multiples.to_vec(), samples: self.laws.of_scores(&scores), weights }
    }

    /// Laws about the points of least remaining margin, by requirement, at the distance that corresponds to `may_fail`;
    /// the least of all first.
    fn mixture(&self, multiples: &[f64]) -> Mixture {
        let distance = -normal_quantile(self.may_fail);
        let slacks = |points: &[Vec<f64>]| self.scaled(multiples, self.laws.of_scores(points).points().iter());
        let (points, _) = Mixture::default().replicate(0, self.laws.dimension(), TUNING.points);
        let all = slacks(&points);
        let mut places: Vec<(f64, Vec<f64>)> = Vec::new();
        for (requirement, own) in all.chunks_exact(points.len()).enumerate() {
            let slack = |points: &[Vec<f64>]| slacks(points)[requirement * points.len()..][..points.len()].to_vec();
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&a, &b| own[a].total_cmp(&own[b]).then(a.cmp(&b)));
            let found = order
                .iter()
                .take(STATISTICS.starts_of_places)
                .filter_map(|&start| least_at_distance(&points[start], distance, &slack));
            places.extend(found.map(|index| (slack(std::slice::from_ref(&index))[0], index)));
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut mixture = Mixture::default();
        places.into_iter().for_each(|(_, index)| mixture.add(index, TUNING.places));
        mixture
    }

    /// The samples' slacks, by requirement; and the samples' weights.
    fn slacks(&mut self, multiples: &[f64]) -> (Vec<f64>, Vec<f64>) {
        self.draw(multiples);
        let Some(drawn) = &self.drawn else { return Default::default() };
        (self.scaled(multiples, drawn.samples.points().iter()), drawn.weights.clone())
    }

    /// The least slack of each of `n` samples over all requirements.
    fn worst(&self, slacks: &[f64], n: usize) -> Vec<f64> {
        let least =
            |sample: usize| (0..self.surface.count).map(|own| slacks[own * n + sample]).fold(f64::INFINITY, f64::min);
        (0..n).map(least).collect()
    }

    /// Numbers of the samples about the quantile of some values.
    fn beside(&self, values: &[f64], weights: &[f64]) -> Vec<usize> {
        let shares = shares_below(values, weights);
        let index = |times: f64| shares.partition_point(|(_, below)| *below < times * self.may_fail);
        let (from, to) = (index(TUNING.beside_quantile[0]), index(TUNING.beside_quantile[1]));
        let (from, to) =
            if to < from + TUNING.fewest_beside { (0, TUNING.fewest_beside.min(shares.len())) } else { (from, to) };
        shares[from..to].iter().map(|(number, _)| *number).collect()
    }

    /// Mean derivatives of slacks of some samples with respect to the multiples; `pick` takes a sample's slack out of
    /// those of all.
    fn slopes(&self, multiples: &[f64], which: &[usize], pick: impl Fn(&[f64], usize) -> f64) -> Vec<f64> {
        let Some(drawn) = &self.drawn else { return vec![0.0; multiples.len()] };
        let samples = drawn.samples.points();
        let weight: f64 = which.iter().map(|&index| drawn.weights[index]).sum();
        let slope = |axis: usize| {
            let mean = |sign: f64| {
                let mut moved = multiples.to_vec();
                moved[axis] *= 1.0 + sign * TUNING.step_of_difference;
                let slacks = self.scaled(&moved, which.iter().map(|&index| samples.point(index)));
                let own = |(index, &number): (usize, &usize)| drawn.weights[number] * pick(&slacks, index);
                which.iter().enumerate().map(own).sum::<f64>() / weight
            };
            (mean(1.0) - mean(-1.0)) / (2.0 * TUNING.step_of_difference * multiples[axis])
        };
        (0..multiples.len()).map(slope).collect()
    }
}

impl Slack for Share<'_> {
    fn is_interrupted(&self) -> bool {
        (self.interrupted)()
    }

    /// The quantile of each requirement's own slack.
    fn left(&mut self, multiples: &[f64]) -> Vec<f64> {
        let (slacks, weights) = self.slacks(multiples);
        slacks.chunks_exact(weights.len()).map(|own| weighted_quantile(own, &weights, self.may_fail)).collect()
    }

    fn is_known_to_fail(&self, _: &[f64]) -> bool {
        false
    }

    fn linearised(&mut self, multiples: &[f64]) -> Vec<Linear> {
        let (slacks, weights) = self.slacks(multiples);
        let values = self.worst(&slacks, weights.len());
        let beside = self.beside(&values, &weights);
        let (count, n) = (self.surface.count, beside.len());
        let pick =
            |slacks: &[f64], index: usize| (0..count).map(|own| slacks[own * n + index]).fold(f64::INFINITY, f64::min);
        let slopes = self.slopes(multiples, &beside, pick);
        // With respect to the squares.
        let slopes = slopes.iter().zip(multiples).map(|(slope, multiple)| slope / (2.0 * multiple)).collect();
        vec![Linear { value: weighted_quantile(&values, &weights, self.may_fail), slopes }]
    }

    fn power(&self) -> Power {
        Power::Second
    }

    fn slopes_at_least(&mut self, multiples: &[f64], requirement: usize) -> Vec<f64> {
        let (slacks, weights) = self.slacks(multiples);
        let beside = self.beside(&slacks[requirement * weights.len()..][..weights.len()], &weights);
        let count = beside.len();
        self.slopes(multiples, &beside, |slacks, index| slacks[requirement * count + index])
    }

    fn reserves(&mut self) -> &mut [f64] {
        &mut self.surface.reserves
    }

    fn allow(&mut self, may_fail: f64) {
        self.may_fail = may_fail;
    }

    /// The quantile of the least slack over all requirements.
    fn least(&mut self, multiples: &[f64]) -> f64 {
        let (slacks, weights) = self.slacks(multiples);
        weighted_quantile(&self.worst(&slacks, weights.len()), &weights, self.may_fail)
    }
}
