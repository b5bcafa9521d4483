//! The joint law of all uncertain parameters of a model.

use super::tuning::TUNING;
use super::zones::LawInZone;
use super::{intervals, law_summary};
use crate::model::{Description, Law};
use crate::numerics::statistics::{Copula, Distribution, Quantiles, normal_quantile, replicate};
use crate::results::LawSummary;
use symdiff::math;

/// Laws and correlations of the uncertain parameters in the model's order.
pub struct Laws {
    /// Names of the parameters.
    pub names: Vec<String>,
    laws: Vec<Law>,
    /// Their values.
    quantiles: Vec<Quantiles>,
    /// Lower ends of the box that is bounded, SI.
    pub lower: Vec<f64>,
    /// Its upper ends, SI.
    pub upper: Vec<f64>,
    /// Nominal values, SI.
    pub nominal: Vec<f64>,
    /// The box that samples are drawn from.
    least: Vec<f64>,
    most: Vec<f64>,
    /// Correlations.
    pub copula: Copula,
    /// Joint laws of parameters in zones.
    zones: Vec<LawInZone>,
}

impl Laws {
    /// Laws of a model.
    ///
    /// # Errors
    /// If nothing is uncertain.
    pub fn of(description: &Description) -> Result<Self, String> {
        let all: Vec<(&str, [f64; 3])> = intervals(description).collect();
        if all.is_empty() {
            return Err("no parameter is uncertain".to_owned());
        }
        let of = |&(name, [_, lower, upper]): &(&str, [f64; 3])| description.statistics.law(name, lower, upper);
        let along = |which: usize| -> Vec<f64> { all.iter().map(|(_, ends)| ends[which]).collect() };
        let names: Vec<String> = all.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut matrix: Vec<Vec<f64>> =
            (0..names.len()).map(|i| (0..names.len()).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        for group in &description.statistics.correlations {
            let indices: Vec<Option<usize>> =
                group.names.iter().map(|name| names.iter().position(|known| known == name)).collect();
            for (i, row) in indices.iter().zip(&group.matrix) {
                for (j, &value) in indices.iter().zip(row) {
                    if let (Some(i), Some(j)) = (*i, *j) {
                        matrix[i][j] = value;
                    }
                }
            }
        }
        let copula =
            Copula::new(&matrix).map_err(|_| "the matrix of correlations is not positive definite".to_owned())?;
        let (nominal, lower, upper) = (along(0), along(1), along(2));
        let laws: Vec<Law> = all.iter().map(of).collect();
        let quantiles = laws.iter().map(|law| Quantiles::new(&law.distribution)).collect();
        let zones = LawInZone::all(description, &names);
        Ok(Self {
            names,
            laws,
            quantiles,
            zones,
            least: lower.clone(),
            most: upper.clone(),
            lower,
            upper,
            nominal,
            copula,
        })
    }

    /// Number of parameters.
    pub fn dimension(&self) -> usize {
        self.laws.len()
    }

    /// Whether something may lie outside of the box.
    pub fn reach_beyond(&self) -> bool {
        self.outside() > 0.0
    }

    /// Has samples drawn from a box that has nearly all of the laws.
    pub fn widen(&mut self) {
        for (index, law) in self.laws.iter().enumerate() {
            (self.least[index], self.most[index]) = ends(law, (self.lower[index], self.upper[index]));
        }
    }

    /// The box that samples are drawn from: ends of each parameter.
    pub fn drawn(&self) -> impl Iterator<Item = [f64; 2]> {
        self.least.iter().zip(&self.most).map(|(least, most)| [*least, *most])
    }

    /// Cuts off normal and lognormal laws at the box' ends.
    pub fn cut_off(&mut self) {
        (self.least, self.most) = (self.lower.clone(), self.upper.clone());
        for (index, law) in self.laws.iter_mut().enumerate() {
            if let Distribution::Normal { mean, sigma } = law.distribution {
                let (lower, upper) = (self.lower[index], self.upper[index]);
                law.distribution = Distribution::TruncatedNormal { mean, sigma, lower, upper };
            }
            if let Distribution::Lognormal { lower, upper, .. } = &mut law.distribution {
                (*lower, *upper) = (lower.max(self.lower[index]), upper.min(self.upper[index]));
            }
            self.quantiles[index] = Quantiles::new(&law.distribution);
        }
    }

    /// Largest probability outside the box that is bounded.
    pub fn outside(&self) -> f64 {
        self.laws
            .iter()
            .zip(self.lower.iter().zip(&self.upper))
            .map(|(law, (a, b))| law.distribution.outside(*a, *b))
            .sum()
    }

    /// Largest probability outside the domain from which samples are drawn.
    pub fn left_out(&self) -> f64 {
        self.laws
            .iter()
            .zip(self.least.iter().zip(&self.most))
            .map(|(law, (a, b))| law.distribution.outside(*a, *b))
            .sum()
    }

    /// One replicate of samples, sample after sample: values of all parameters.
    pub fn samples(&self, number: usize, count: usize) -> Vec<f64> {
        let mut samples = replicate(number, self.dimension(), count);
        for sample in samples.chunks_exact_mut(self.dimension()) {
            if self.copula.is_independent() {
                self.replace(sample, Quantiles::of_share);
            } else {
                sample.iter_mut().for_each(|share| *share = normal_quantile(*share));
                self.replace_scores(sample);
            }
        }
        samples
    }

    /// The sample with these independent normal scores.
    pub fn of_scores(&self, scores: &[f64]) -> Vec<f64> {
        let mut sample = scores.to_vec();
        self.replace_scores(&mut sample);
        sample
    }

    /// Replaces independent normal scores with the sample that has them.
    pub fn replace_scores(&self, sample: &mut [f64]) {
        self.copula.correlate_scores(sample);
        self.replace(sample, Quantiles::of_score);
    }

    /// Replaces numbers of the parameters with their values, within the box that samples are drawn from.
    fn replace(&self, sample: &mut [f64], value: impl Fn(&Quantiles, f64) -> f64) {
        for (index, (number, quantiles)) in sample.iter_mut().zip(&self.quantiles).enumerate() {
            *number = value(quantiles, *number).clamp(self.least[index], self.most[index]);
        }
        self.zones.iter().for_each(|zone| zone.place(sample));
    }

    /// As they are printed.
    pub fn summaries(&self) -> Vec<LawSummary> {
        let ends = self.lower.iter().copied().zip(self.upper.iter().copied());
        self.names.iter().zip(&self.laws).zip(ends).map(|((name, law), ends)| law_summary(name, law, ends)).collect()
    }
}

/// The ends of an interval that has nearly all of a law.
pub(super) fn ends(law: &Law, (lower, upper): (f64, f64)) -> (f64, f64) {
    match law.distribution {
        Distribution::Normal { mean, sigma } => {
            (lower.min(mean - TUNING.sigmas_of_surrogate * sigma), upper.max(mean + TUNING.sigmas_of_surrogate * sigma))
        }
        Distribution::Lognormal { median, sigma, .. } => {
            let far = math::exp(TUNING.sigmas_of_surrogate * sigma);
            (lower.min(median / far), upper.max(median * far))
        }
        _ => (lower, upper),
    }
}
