//! Statistics of simulated products with a surrogate as control variate (J. M. Hammersley & D. C. Handscomb, Monte
//! Carlo Methods, 1964, § 5.5): its own are known by as many samples as one likes, and products tell the rest.
//!
//! With the mean μ(s) of the surrogate over the laws, μ(f) = μ(f − β s) + β μ(s), where β is the regression
//! coefficient of the products' values on the surrogate's. The variance follows likewise from squares about the means.
//! Let s′ = f̄ + β (s − s̄). If a share δ of the products differs from s′ by more than ε, a quantile lies between those
//! of s′ whose shares are δ less and δ more, and ε beyond them; it also lies between two of the products' sorted
//! values. The interval that leaves least open counts.

use super::tuning::TUNING;
use crate::numerics::statistics::{Estimate, Replicates};
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
    /// By quantile: that of the simulated values.
    simulated: Vec<Between>,
    /// The largest differences but so many as may be beyond ε.
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

/// An estimate, and the interval that it lies in.
#[derive(Clone, Copy, Debug)]
struct Between {
    value: f64,
    lower: f64,
    upper: f64,
}

/// Mean, standard deviation and quantiles.
pub(super) struct Moments {
    pub mean: Uncertain,
    pub deviation: Uncertain,
    pub quantiles: Vec<Uncertain>,
}

impl ControlVariate {
    /// From simulated values and those of the surrogate at the same samples; `below`: numbers of values below
    /// quantiles, at least, by the share, and at most.
    pub fn new<'v>(values: impl Iterator<Item = &'v f64>, surrogate: &[f64], below: &[[usize; 3]]) -> Self {
        let mut values: Vec<f64> = values.copied().collect();
        let mean = Regression::of(&values, surrogate);
        let squares = |values: &[f64], mean: f64| -> Vec<f64> {
            let unbiased = values.len() as f64 / (values.len() as f64 - 1.0);
            values.iter().map(|value| unbiased * (value - mean) * (value - mean)).collect()
        };
        let variance = Regression::of(&squares(&values, mean.to), &squares(surrogate, mean.from));
        let largest = largest(values.iter().zip(surrogate).map(|(value, own)| value - mean.at(*own)));
        values.sort_unstable_by(f64::total_cmp);
        let simulated = below.iter().map(|&[least, own, most]| {
            let lower = least.checked_sub(1).map_or(f64::NEG_INFINITY, |index| values[index]);
            let upper = values.get(most).copied().unwrap_or(f64::INFINITY);
            Between { value: values[own.min(values.len() - 1)], lower, upper }
        });
        Self { mean, variance, simulated: simulated.collect(), largest }
    }

    /// Statistics of the products, from those of the surrogate. `of_box`: how far any value may be off; `time`: the
    /// part of it that the steps leave. A product that cannot be simulated leaves all unknown.
    pub fn corrected(&self, own: &Replicates, of_box: f64, time: f64) -> Moments {
        let mean = self.mean.of_mean(own.mean());
        let quantiles = own.quantiles();
        let around = quantiles.chunks_exact(AROUND).zip(&self.simulated);
        let quantile = |(around, simulated): (&[Estimate], &Between)| self.quantile(around, *simulated, of_box, time);
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

    /// A quantile, given those of the surrogate at the shares around it, and that of the simulated values.
    fn quantile(&self, around: &[Estimate], simulated: Between, of_box: f64, time: f64) -> Uncertain {
        let Estimate { value: own, sampling } = around[0];
        if self.mean.to.is_nan() {
            return Uncertain { value: own, sampling, error: f64::NAN };
        }
        let value = self.mean.at(own);
        let pairs = around[1..].chunks_exact(2).zip(self.largest);
        let by_differences = pairs.map(|(pair, largest)| Between {
            value,
            lower: self.mean.at(pair[0].value) - largest,
            upper: self.mean.at(pair[1].value) + largest,
        });
        let by_box = Between { value: own, lower: own - of_box + time, upper: own + of_box - time };
        let by_differences = by_differences.map(|found| (found, self.mean.coefficient * sampling));
        let others = [(by_box, sampling), (simulated, 0.0)];
        let least = by_differences.chain(others).map(|(found, sampling)| (found, sampling, found.error() + sampling));
        // The simulated values are always there.
        let least = least.reduce(|a, b| if b.2 < a.2 { b } else { a }).unwrap_or((simulated, 0.0, 0.0));
        Uncertain { value: least.0.value, sampling: least.1, error: least.0.error() + time }
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

    /// The values' mean, from that of the surrogate.
    fn of_mean(&self, own: Estimate) -> Estimate {
        Estimate { value: self.at(own.value), sampling: self.coefficient * own.sampling + self.sampling }
    }
}

impl Between {
    /// How far the truth may be from the estimate; infinite where that is not known.
    fn error(&self) -> f64 {
        let error = (self.upper - self.value).max(self.value - self.lower);
        if error.is_nan() { f64::INFINITY } else { error }
    }
}

impl Moments {
    /// Those of the surrogate, all with one error.
    pub fn of(own: &Replicates, error: f64) -> Self {
        let uncertain = |Estimate { value, sampling }: Estimate| Uncertain { value, sampling, error };
        let quantiles = own.quantiles().into_iter().map(uncertain).collect();
        Self { mean: uncertain(own.mean()), deviation: uncertain(own.deviation()), quantiles }
    }

    /// Whether all errors are known.
    pub fn are_known(&self) -> bool {
        let all = [&self.mean, &self.deviation].into_iter().chain(&self.quantiles);
        all.into_iter().all(|own| (own.sampling + own.error).is_finite())
    }
}

/// The largest sizes of differences but so many as may be beyond ε; NaN if one of them is.
pub(super) fn largest(differences: impl Iterator<Item = f64>) -> [f64; BEYOND] {
    let mut sizes: Vec<f64> = differences.map(f64::abs).collect();
    // NaN is the largest.
    sizes.sort_unstable_by(f64::total_cmp);
    let is_known = sizes.last().is_some_and(|size| !size.is_nan());
    TUNING.beyond_error.map(|beyond| if is_known { sizes[sizes.len() - 1 - beyond] } else { f64::NAN })
}
