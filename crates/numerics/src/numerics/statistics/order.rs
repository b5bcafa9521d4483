//! Mean, deviation and quantiles of independent samples, with confidence intervals.

use super::beta::beta_quantile;
use super::estimates::Estimate;
use super::special::normal_quantile;

/// Half width of a 95 % confidence interval in standard deviations.
fn two_sided() -> f64 {
    normal_quantile(0.975)
}

/// Mean of independent samples.
pub fn sample_mean(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let value = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - value) * (x - value)).sum();
    Estimate { value, sampling: two_sided() * (squares / (n * (n - 1.0))).sqrt() }
}

/// Standard deviation of independent samples; the interval is that of its square, by the fourth moment, whatever the
/// law.
pub fn sample_deviation(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let moment = |power: i32| values.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / n;
    let (second, fourth) = (moment(2), moment(4));
    let value = (second * n / (n - 1.0)).sqrt();
    let of_square = two_sided() * ((fourth - second * second).max(0.0) / n).sqrt();
    Estimate { value, sampling: if value > 0.0 { of_square / (2.0 * value) } else { 0.0 } }
}

/// The value below which a share lies, of sorted independent samples, with its 95 % confidence interval.
pub fn sample_quantile(sorted: &[f64], share: f64) -> Estimate {
    SampleQuantile::new(share, sorted.len(), 0.05).of(sorted)
}

/// Whether `count` samples have a confidence interval for a quantile.
pub fn has_interval(share: f64, count: usize) -> bool {
    ranks(share, count, 0.05).is_some()
}

/// The quantile of a number of sorted independent samples. Its confidence interval has samples as ends, for any law:
/// the number below the quantile has a binomial law.
#[derive(Clone, Debug)]
pub struct SampleQuantile {
    share: f64,
    ranks: Option<[usize; 2]>,
}

impl SampleQuantile {
    /// The quantile of a share, with an interval that has the truth outside with the probability `outside`.
    pub fn new(share: f64, count: usize, outside: f64) -> Self {
        Self { share, ranks: ranks(share, count, outside) }
    }

    /// Estimate from these samples; NaN if they are too few for an interval, or if one is NaN.
    pub fn of(&self, sorted: &[f64]) -> Estimate {
        let n = sorted.len();
        let unknown = Estimate { value: f64::NAN, sampling: f64::NAN };
        if [sorted.first(), sorted.last()].iter().any(|end| end.is_none_or(|value| value.is_nan())) {
            return unknown;
        }
        let Some([below, above]) = self.ranks else { return unknown };
        let index = (self.share * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
        let (at, between) = (index as usize, index.fract());
        let value = sorted[at] + between * (sorted[(at + 1).min(n - 1)] - sorted[at]);
        Estimate { value, sampling: (value - sorted[below - 1]).max(sorted[above - 1] - value) }
    }
}

/// Ranks, from 1, of the samples between which a quantile lies but for so much.
fn ranks(share: f64, n: usize, outside: f64) -> Option<[usize; 2]> {
    // The i-th smallest of n shares is of the law Beta(i, n + 1 − i).
    let is_below = |i: usize| beta_quantile(1.0 - 0.5 * outside, i as f64, (n + 1 - i) as f64) <= share;
    let is_above = |i: usize| beta_quantile(0.5 * outside, i as f64, (n + 1 - i) as f64) >= share;
    let (mut below, mut from) = (0, n);
    while below < from {
        let middle = (below + from).div_ceil(2);
        if is_below(middle) { below = middle } else { from = middle - 1 }
    }
    let (mut above, mut to) = (1, n + 1);
    while above < to {
        let middle = usize::midpoint(above, to);
        if is_above(middle) { to = middle } else { above = middle + 1 }
    }
    (below > 0 && above <= n).then_some([below, above])
}

#[cfg(test)]
mod tests {
    use super::super::normals::Normals;
    use super::*;

    #[test]
    fn intervals_contain_the_truth_at_their_confidence() {
        let (runs, count) = (400, 800);
        let mut held = [0; 4];
        for run in 0..runs {
            let mut values: Vec<f64> = Normals::new(run).draw(count).iter().map(|x| 3.0 + 2.0 * x).collect();
            let [mean, deviation] = [sample_mean(&values), sample_deviation(&values)];
            values.sort_unstable_by(f64::total_cmp);
            let [median, high] = [0.5, 0.99].map(|share| sample_quantile(&values, share));
            let truths = [3.0, 2.0, 3.0, 3.0 + 2.0 * normal_quantile(0.99)];
            for (held, (found, truth)) in held.iter_mut().zip([mean, deviation, median, high].iter().zip(truths)) {
                *held += usize::from((found.value - truth).abs() <= found.sampling);
            }
        }
        // 95 % of 400 are 380, with a deviation of 4.4; intervals of quantiles are wider.
        assert!(held.iter().all(|held| (362..=400).contains(held)), "{held:?}");
        assert!(held[0] < 396 && held[1] < 396, "{held:?}");
    }

    #[test]
    fn few_samples_have_no_far_quantile() {
        let sorted: Vec<f64> = (0..100).map(f64::from).collect();
        assert!(sample_quantile(&sorted, 0.999).value.is_nan());
        // The median of 100 samples lies between the 40th and the 61st (tables of the sign test).
        let median = sample_quantile(&sorted, 0.5);
        assert!((median.value, median.sampling) == (49.5, 10.5), "{median:?}");
    }
}
