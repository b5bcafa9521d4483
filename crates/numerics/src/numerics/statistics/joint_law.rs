//! The law of several parameters together: a law of each, tied by a normal copula, within a box.

use super::copula::Copula;
use super::distribution::Distribution;
use super::points::replicate;
use super::quantiles::Quantiles;
use super::special::normal_quantile;
use crate::numerics::PointSet;

/// A joint law.
#[derive(Clone, Debug)]
pub struct JointLaw {
    /// By parameter.
    quantiles: Vec<Quantiles>,
    copula: Copula,
    /// Ends of the box: values beyond are moved to them.
    box_ends: Vec<[f64; 2]>,
}

impl JointLaw {
    /// Laws of each parameter, their correlations, and the ends of the box.
    pub fn new<'l>(laws: impl Iterator<Item = &'l Distribution>, copula: Copula, box_ends: Vec<[f64; 2]>) -> Self {
        Self { quantiles: laws.map(Quantiles::new).collect(), copula, box_ends }
    }

    /// Number of parameters.
    pub fn dimension(&self) -> usize {
        self.quantiles.len()
    }

    /// Ends of the box, by parameter.
    pub fn box_ends(&self) -> &[[f64; 2]] {
        &self.box_ends
    }

    /// Changes the box.
    pub fn set_box(&mut self, box_ends: Vec<[f64; 2]>) {
        self.box_ends = box_ends;
    }

    /// Changes the laws, not their correlations.
    pub fn set_laws<'l>(&mut self, laws: impl Iterator<Item = &'l Distribution>) {
        self.quantiles = laws.map(Quantiles::new).collect();
    }

    /// Values of the parameters at the points of a replicate of the lattice: `count` is a power of two up to 2^20.
    pub fn samples(&self, number: usize, count: usize) -> PointSet {
        let mut samples = PointSet::new(replicate(number, self.dimension(), count), self.dimension());
        samples.for_each_mut(|sample| {
            if self.copula.is_independent() {
                self.replace(sample, Quantiles::of_share);
            } else {
                sample.iter_mut().for_each(|share| *share = normal_quantile(*share));
                self.replace_scores(sample);
            }
        });
        samples
    }

    /// Values of the parameters at points with these independent normal scores.
    pub fn of_scores(&self, points: &[Vec<f64>]) -> PointSet {
        let mut samples = PointSet::of(points);
        samples.for_each_mut(|sample| self.replace_scores(sample));
        samples
    }

    fn replace_scores(&self, sample: &mut [f64]) {
        self.copula.correlate_scores(sample);
        self.replace(sample, Quantiles::of_score);
    }

    /// Replaces numbers of the parameters with their values, within the box.
    fn replace(&self, sample: &mut [f64], value: impl Fn(&Quantiles, f64) -> f64) {
        for ((number, quantiles), [least, most]) in sample.iter_mut().zip(&self.quantiles).zip(&self.box_ends) {
            *number = value(quantiles, *number).clamp(*least, *most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two normal laws of which one is cut off by the box.
    fn normals(correlation: f64) -> JointLaw {
        let law = Distribution::Normal { mean: 1.0, sigma: 0.5 };
        let copula = Copula::new(&[vec![1.0, correlation], vec![correlation, 1.0]]).unwrap();
        JointLaw::new([&law, &law].into_iter(), copula, vec![[-9.0, 9.0], [0.5, 9.0]])
    }

    #[test]
    fn scores_are_values_within_the_box() {
        let samples = normals(0.6).of_scores(&[vec![1.0, 0.0], vec![0.0, -2.0]]);
        let found: Vec<&[f64]> = samples.points().iter().collect();
        // The second score is 0.6 z₀ + 0.8 z₁.
        for (found, wanted) in found.iter().zip([[1.5, 1.3], [1.0, 0.5]]) {
            assert!(found.iter().zip(wanted).all(|(own, wanted)| (own - wanted).abs() < 1e-12), "{found:?}");
        }
    }

    #[test]
    fn samples_have_the_correlation() {
        for correlation in [0.0, 0.6] {
            let samples = normals(correlation).samples(0, 1 << 12);
            let product = |sample: &[f64]| (sample[0] - 1.0) / 0.5 * ((sample[1] - 1.0) / 0.5);
            let found = samples.points().iter().map(product).sum::<f64>() / f64::from(1 << 12);
            // The second parameter's score is at least -1: its covariance with the first is ρ Φ(1).
            assert!((found - 0.841_345 * correlation).abs() < 2e-3, "{correlation}: {found}");
        }
    }
}
