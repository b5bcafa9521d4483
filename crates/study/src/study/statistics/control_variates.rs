//! Statistics of simulated products with a surrogate as control variate (J. M. Hammersley & D. C. Handscomb, Monte
//! Carlo Methods, 1964, § 5.5): its own are known by any number of samples, and products determine the rest.
//!
//! With the mean μ(s) of the surrogate over the laws, μ(f) = μ(f − β s) + β μ(s), where β is the regression
//! coefficient of the products' values on the surrogate's. The variance follows likewise from squares about the means.
//! Let s′ = f̄ + β (s − s̄). If a share δ of the products differs from s′ by more than ε, a quantile lies between those
//! of s′ whose shares are δ less and δ more, and ε beyond them; it also lies between two of the products' sorted
//! values. The interval that leaves least open counts.

use super::tuning::TUNING;
use crate::numerics::statistics::{Estimate, Replicates, SampleQuantile};
use crate::results::Uncertain;

/// Half width of a 95 % confidence interval over the standard error.
const CONFIDENCE: f64 = 1.96;

/// Numbers of products that may differ by more than some ε.
const BEYOND: usize = TUNING.beyond_error.len();

/// Shares around a quantile, itself included.
const AROUND: usize = 1 + 2 * TUNING.beyond_error.len();

/// An output's simulated values, and its surrogate as their control variate.
#[derive(Clone, Debug)]
pub(super) struct ControlVariate {
    mean: Regression,
    variance: Regression,
    /// Quantiles of the simulated values alone.
    simulated: Vec<Estimate>,
    /// For each number of differences that may be beyond ε, the largest of the others.
    largest: [f64; BEYOND],
}

/// A linear relation between means: that of values is `to` where that of the surrogate's is `from`.
#[derive(Clone, Copy, Debug)]
struct Regression {
    coefficient: f64,
    from: f64,
    to: f64,
    /// Half width of the 95 % confidence interval of the values' mean, given the surrogate's.
    sampling: f64,
}

/// Mean, standard deviation and quantiles.
pub(super) struct Moments {
    pub mean: Uncertain,
    pub deviation: Uncertain,
    pub quantiles: Vec<Uncertain>,
}

impl ControlVariate {
    /// Estimates from simulated values and those of the surrogate at the same samples; `quantiles` are those of the
    /// values alone.
    pub fn new<'v>(values: impl Iterator<Item = &'v f64>, surrogate: &[f64], quantiles: &[SampleQuantile]) -> Self {
        let mut values: Vec<f64> = values.copied().collect();
        let mean = Regression::of(&values, surrogate);
        let squares = |values: &[f64], mean: f64| -> Vec<f64> {
            let unbiased = values.len() as f64 / (values.len() as f64 - 1.0);
            values.iter().map(|value| unbiased * (value - mean) * (value - mean)).collect()
        };
        let variance = Regression::of(&squares(&values, mean.to), &squares(surrogate, mean.from));
        let largest = largest(values.iter().zip(surrogate).map(|(value, own)| value - mean.at(*own)));
        values.sort_unstable_by(f64::total_cmp);
        let simulated = quantiles.iter().map(|quantile| quantile.of(&values));
        Self { mean, variance, simulated: simulated.collect(), largest }
    }

    /// Statistics of the products, from those of the surrogate. `of_box`: how far any value may be off; `time`: the
    /// part of it that the steps leave. A product that cannot be simulated leaves all unknown.
    pub fn corrected(&self, own: &Replicates, of_box: f64, time: f64) -> Moments {
        let mean = self.mean.of_mean(own.mean());
        let quantiles = own.quantiles();
        let around = quantiles.chunks_exact(AROUND).zip(&self.simulated);
        let quantile = |(around, simulated): (&[Estimate], &Estimate)| self.quantile(around, *simulated, of_box, time);
        Moments {
            mean: Uncertain { value: mean.value, sampling: mean.sampling, error: time },
            deviation: self.deviation(own.deviation(), time),
            quantiles: around.map(quantile).collect(),
        }
    }

    fn deviation(&self, own: Estimate, time: f64) -> Uncertain {
        let squared = Estimate { value: own.value * own.value, sampling: 2.0 * own.value * own.sampling };
        let variance = self.variance.of_mean(squared);
        // Written so that NaN stays.
        let root = |variance: f64| if variance < 0.0 { 0.0 } else { variance.sqrt() };
        let value = root(variance.value);
        let [lower, upper] = [-1.0, 1.0].map(|side| root(variance.value + side * variance.sampling));
        Uncertain { value, sampling: (upper - value).max(value - lower), error: time }
    }

    /// A quantile, given those of the surrogate at the shares around it, and that of the simulated values alone.
    fn quantile(&self, around: &[Estimate], simulated: Estimate, of_box: f64, time: f64) -> Uncertain {
        let Estimate { value: own, sampling } = around[0];
        if self.mean.to.is_nan() {
            return Uncertain { value: own, sampling, error: f64::NAN };
        }
        let Estimate { value, sampling: regressed } = self.mean.scaled(around[0]);
        let by_differences = around[1..].chunks_exact(2).zip(self.largest).map(|(pair, largest)| {
            let ends = [pair[0].value, pair[1].value].map(|end| self.mean.at(end));
            Uncertain { value, sampling: regressed, error: (ends[1] - value).max(value - ends[0]) + largest + time }
        });
        let by_box = Uncertain { value: own, sampling, error: of_box };
        let alone = Uncertain { value: simulated.value, sampling: 0.0, error: simulated.sampling + time };
        // Written so that the unknown is the last.
        by_differences
            .chain([by_box])
            .fold(alone, |a, b| if a.total() <= b.total() || b.total().is_nan() { a } else { b })
    }
}

impl Regression {
    fn of(values: &[f64], surrogate: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
        let [to, from] = [mean(values), mean(surrogate)];
        let pairs = || values.iter().zip(surrogate).map(|(value, own)| (value - to, own - from));
        let [together, own] = pairs().fold([0.0; 2], |[together, own], (value, s)| [together + value * s, own + s * s]);
        // Shares below quantiles carry over only if values grow with the surrogate.
        let coefficient = if own > 0.0 && together > 0.0 { together / own } else { 0.0 };
        let squares: f64 = pairs().map(|(value, own)| (value - coefficient * own).powi(2)).sum();
        let sampling = CONFIDENCE * (squares / (count - 1.0) / count).sqrt();
        Self { coefficient, from, to, sampling }
    }

    fn at(&self, surrogate: f64) -> f64 {
        self.to + self.coefficient * (surrogate - self.from)
    }

    /// An estimate of the surrogate's, as one of the values.
    fn scaled(&self, own: Estimate) -> Estimate {
        Estimate { value: self.at(own.value), sampling: self.coefficient * own.sampling }
    }

    /// The values' mean, from that of the surrogate.
    fn of_mean(&self, own: Estimate) -> Estimate {
        let Estimate { value, sampling } = self.scaled(own);
        Estimate { value, sampling: sampling + self.sampling }
    }
}

impl Moments {
    /// Estimates of the surrogate, all with one error.
    pub fn of(own: &Replicates, error: f64) -> Self {
        let uncertain = |Estimate { value, sampling }: Estimate| Uncertain { value, sampling, error };
        let quantiles = own.quantiles().into_iter().map(uncertain).collect();
        Self { mean: uncertain(own.mean()), deviation: uncertain(own.deviation()), quantiles }
    }

    /// Whether all errors are known.
    pub fn are_known(&self) -> bool {
        [&self.mean, &self.deviation].into_iter().chain(&self.quantiles).all(|own| own.total().is_finite())
    }
}

/// For each number of differences that may be beyond ε, the largest size of the others; NaN if a difference is NaN.
pub(super) fn largest(differences: impl Iterator<Item = f64>) -> [f64; BEYOND] {
    let mut sizes: Vec<f64> = differences.map(f64::abs).collect();
    // NaN is the largest.
    sizes.sort_unstable_by(f64::total_cmp);
    let is_known = sizes.last().is_some_and(|size| !size.is_nan());
    TUNING.beyond_error.map(|beyond| if is_known { sizes[sizes.len() - 1 - beyond] } else { f64::NAN })
}
