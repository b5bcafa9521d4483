//! Mean, standard deviation and quantiles from replicates of samples, with how far sampling may leave them off.

use super::beta::beta_quantile;
use super::points::REPLICATES;
use super::tuning::TUNING;

/// Student's t for 95 % on both sides with one degree of freedom less than there are replicates (Abramowitz & Stegun,
/// table 26.10).
pub(super) const STUDENT: f64 = 2.131;

/// An estimate, and the half width of its 95 % confidence interval as far as sampling goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The half width.
    pub sampling: f64,
}

impl Estimate {
    /// The mean of values of replicates.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let value = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - value) * (x - value)).sum();
        Self { value, sampling: STUDENT * (squares / (n * (n - 1.0))).sqrt() }
    }
}

/// The 95 % confidence interval of a share that was seen in `seen` of `of` samples (C. J. Clopper & E. S. Pearson,
/// Biometrika 26 (1934) 404). Points that are spread evenly are no worse than random ones.
pub fn share_interval(seen: usize, of: usize) -> [f64; 2] {
    let (seen, left) = (seen as f64, of.saturating_sub(seen) as f64);
    let lower = if seen == 0.0 { 0.0 } else { beta_quantile(0.025, seen, left + 1.0) };
    let upper = if left == 0.0 { 1.0 } else { beta_quantile(0.975, seen + 1.0, left) };
    [lower, upper]
}

/// Statistics of one quantity from replicates of its samples.
#[derive(Clone, Debug, Default)]
pub struct Replicates {
    means: Vec<f64>,
    /// Variances, each about its replicate's own mean.
    variances: Vec<f64>,
    /// Quantiles, each replicate by replicate.
    quantiles: Vec<Vec<f64>>,
    /// The shares below them.
    shares: Vec<f64>,
    /// Values of all replicates, if they are few.
    pooled: Vec<f64>,
}

impl Replicates {
    /// No replicates yet, with the quantiles below which these shares lie.
    pub fn new(shares: &[f64]) -> Self {
        let quantiles = vec![Vec::with_capacity(REPLICATES); shares.len()];
        Self { quantiles, shares: shares.to_vec(), ..Self::default() }
    }

    /// Adds a replicate, whose values are sorted.
    pub fn add(&mut self, values: &mut [f64]) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        self.means.push(mean);
        self.variances.push(squares / n);
        if values.len() <= TUNING.pooled {
            self.pooled.extend_from_slice(values);
        }
        // NaN is the first or the last.
        values.sort_unstable_by(f64::total_cmp);
        for (quantiles, &share) in self.quantiles.iter_mut().zip(&self.shares) {
            quantiles.push(quantile_of(values, share));
        }
    }

    /// Mean.
    pub fn mean(&self) -> Estimate {
        Estimate::of(&self.means)
    }

    /// Standard deviation, about the mean of all replicates: points of a lattice know it far better than the same
    /// number of random ones, whose variance about their own mean is divided by one less than their number.
    pub fn deviation(&self) -> Estimate {
        let mean = self.mean().value;
        let own =
            self.variances.iter().zip(&self.means).map(|(variance, own)| (variance + (own - mean).powi(2)).sqrt());
        Estimate::of(&own.collect::<Vec<f64>>())
    }

    /// Quantiles, in the order of their shares. Of few samples they are those of all replicates together: a law that
    /// bends between the first or the last values of a replicate leaves all replicates off by the same, of which their
    /// spread says nothing.
    pub fn quantiles(&self) -> Vec<Estimate> {
        let of_replicates = self.quantiles.iter().map(|values| Estimate::of(values));
        if self.pooled.is_empty() {
            return of_replicates.collect();
        }
        let mut sorted = self.pooled.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let together = |(own, share): (Estimate, &f64)| {
            let value = quantile_of(&sorted, *share);
            Estimate { value, sampling: own.sampling + (value - own.value).abs() }
        };
        of_replicates.zip(&self.shares).map(together).collect()
    }
}

/// The value below which a share of them lies, linearly between two of them (R. J. Hyndman & Y. Fan, The American
/// Statistician 50 (1996) 361, type 5), where they are sorted; NaN if one is.
fn quantile_of(sorted: &[f64], share: f64) -> f64 {
    let n = sorted.len();
    if [sorted.first(), sorted.last()].iter().any(|end| end.is_none_or(|value| value.is_nan())) {
        return f64::NAN;
    }
    let index = (share * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
    let (below, between) = (index as usize, index.fract());
    let low = sorted[below];
    match sorted.get(below + 1) {
        Some(high) if between > 0.0 && *high < f64::INFINITY => low + between * (high - low),
        _ => low,
    }
}

#[cfg(test)]
mod tests {
    use super::super::points::replicate;
    use super::super::special::normal_quantile;
    use super::*;

    #[test]
    fn a_normal_laws_numbers_lie_within_their_confidence() {
        let shares = [0.001_349_898, 0.5, 0.998_650_102];
        let mut replicates = Replicates::new(&shares);
        for number in 0..REPLICATES {
            let points = replicate(number, 2, 1 << 14);
            let sum = |p: &[f64]| 2.0 + 3.0 * normal_quantile(p[0]) + 4.0 * normal_quantile(p[1]);
            let mut values: Vec<f64> = points.chunks_exact(2).map(sum).collect();
            replicates.add(&mut values);
        }
        // N(2, 5²)
        let near = |estimate: Estimate, truth: f64, most: f64| {
            let off = (estimate.value - truth).abs();
            assert!(off <= 2.0 * estimate.sampling && estimate.sampling < most, "{estimate:?} {truth}");
        };
        near(replicates.mean(), 2.0, 1e-3);
        near(replicates.deviation(), 5.0, 5e-3);
        let [low, middle, high] = replicates.quantiles()[..] else { panic!("three") };
        near(low, -13.0, 0.1);
        near(middle, 2.0, 1e-2);
        near(high, 17.0, 0.1);
    }

    /// Between the first values of a few samples a law may bend: each replicate is off by the same.
    #[test]
    fn quantiles_of_few_samples_lie_within_their_confidence() {
        let share = 0.001_349_898;
        let of_square: fn(&[f64]) -> f64 = |p| p[0] * p[0] * (1.0 + p[1]);
        let of_power: fn(&[f64]) -> f64 = |p| (0.6 * p[0] + 0.4 * p[1]).powi(6);
        // P(u² (1 + v) < q) = 2 (√2 − 1) √q, and P((0.6 u + 0.4 v)⁶ < q) = q^(1/3) / 0.48, of small q.
        let square = (share / (2.0 * (2.0_f64.sqrt() - 1.0))).powi(2);
        let power = (0.48 * share).powi(3);
        for (law, truth) in [(of_square, square), (of_power, power)] {
            for count in [1 << 9, 1 << 10, 1 << 11] {
                let mut replicates = Replicates::new(&[share]);
                for number in 0..REPLICATES {
                    let mut values: Vec<f64> = replicate(number, 2, count).chunks_exact(2).map(law).collect();
                    replicates.add(&mut values);
                }
                let found = replicates.quantiles()[0];
                let off = (found.value - truth).abs();
                assert!(off <= found.sampling && off < 0.3 * truth, "{count}: {found:?} {truth}");
            }
        }
    }

    /// The mean of lattice points is known far better than that of the same number of random ones: nothing is to be
    /// divided by one less than their number, as if it were not.
    #[test]
    fn deviations_of_lattice_points_lie_within_confidence() {
        let jump: fn(&[f64]) -> f64 = |p| if p[0] + 0.6 * p[1] > 0.8 { 1.0 } else { -1.0 };
        let along: fn(&[f64]) -> f64 = |p| 3.0_f64.sqrt() * (2.0 * p[0] - 1.0);
        let wave: fn(&[f64]) -> f64 = |p| 2.0_f64.sqrt() * (std::f64::consts::TAU * (2.0 * p[0] + p[1])).sin();
        for law in [jump, along, wave] {
            let mut replicates = Replicates::new(&[]);
            for number in 0..REPLICATES {
                let mut values: Vec<f64> = replicate(number, 2, 1 << 10).chunks_exact(2).map(law).collect();
                replicates.add(&mut values);
            }
            let found = replicates.deviation();
            assert!((found.value - 1.0).abs() <= found.sampling + 1e-12 && found.sampling < 1e-3, "{found:?}");
        }
    }

    #[test]
    fn published_confidence_intervals() {
        // None of 20 seen: 1 − 0.025^(1/20). Four of 20: (0.0573, 0.4366), Clopper and Pearson's charts.
        let [lower, upper] = share_interval(0, 20);
        assert!(lower == 0.0 && (upper - (1.0 - 0.025_f64.powf(0.05))).abs() < 1e-12);
        let [lower, upper] = share_interval(4, 20);
        assert!((lower - 0.0573).abs() < 5e-5 && (upper - 0.4366).abs() < 5e-5, "{lower} {upper}");
        assert_eq!(share_interval(7, 7)[1], 1.0);
    }

    #[test]
    fn quantiles_of_few_samples_are_interpolated() {
        let shares = [0.0, 0.125, 0.25, 0.5, 1.0];
        let found = |values: &mut [f64]| {
            let mut replicates = Replicates::new(&shares);
            replicates.add(values);
            replicates.quantiles.concat()
        };
        assert_eq!(found(&mut [4.0, 1.0, 3.0, 2.0]), [1.0, 1.0, 1.5, 2.5, 4.0]);
        for nan in [f64::NAN, -f64::NAN] {
            assert!(found(&mut [1.0, nan, 2.0]).iter().all(|value| value.is_nan()));
        }
    }
}
