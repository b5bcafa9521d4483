//! Laws of a random parameter.

use symdiff::math;

use super::beta::{beta_cdf, beta_quantile};
use super::special::{normal_cdf, normal_quantile};

/// Law of a parameter, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Every value between the ends as likely as any other.
    Uniform {
        /// Ends.
        lower: f64,
        /// Ends.
        upper: f64,
    },
    /// Reaches beyond any interval.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        sigma: f64,
    },
    /// A normal law, truncated to the values between the ends.
    TruncatedNormal {
        /// Mean of the whole law.
        mean: f64,
        /// Standard deviation of the whole law.
        sigma: f64,
        /// Ends.
        lower: f64,
        /// Ends.
        upper: f64,
    },
    /// The logarithm is normal.
    Lognormal {
        /// Half of the whole law lies below.
        median: f64,
        /// Standard deviation of the whole law's logarithm.
        sigma: f64,
        /// Smaller values do not occur; zero if all do.
        lower: f64,
        /// Larger values do not occur; infinite if all do.
        upper: f64,
    },
    /// Its density rises to the mode and falls from it, linearly.
    Triangular {
        /// Ends.
        lower: f64,
        /// The likeliest value.
        mode: f64,
        /// Ends.
        upper: f64,
    },
    /// Its density is (x − lower)^(α−1) (upper − x)^(β−1), but for a factor.
    Beta {
        /// Exponent at the lower end, plus one.
        alpha: f64,
        /// Exponent at the upper end, plus one.
        beta: f64,
        /// Ends.
        lower: f64,
        /// Ends.
        upper: f64,
    },
    /// A density that is linear between points (value, density), ascending; it need not be normalised.
    Table(Vec<(f64, f64)>),
}

impl Distribution {
    /// The value below which a share p, 0 < p < 1, of the law lies.
    pub fn quantile(&self, p: f64) -> f64 {
        match self {
            Self::Uniform { lower, upper } => (1.0 - p) * lower + p * upper,
            Self::Normal { mean, sigma } => mean + sigma * normal_quantile(p),
            Self::TruncatedNormal { mean, sigma, lower, upper } => {
                let [low, high] = [lower, upper].map(|end| (end - mean) / sigma);
                // Uses the thinner tail, so that no digits are lost.
                let value = if low > 0.0 {
                    let (low, high) = (normal_cdf(-low), normal_cdf(-high));
                    -normal_quantile(low + p * (high - low))
                } else {
                    let (low, high) = (normal_cdf(low), normal_cdf(high));
                    normal_quantile(low + p * (high - low))
                };
                (mean + sigma * value).clamp(*lower, *upper)
            }
            Self::Lognormal { median, sigma, lower, upper } => {
                let [low, high] = log_scores(*median, *sigma, *lower, *upper).map(normal_cdf);
                (median * math::exp(sigma * normal_quantile(low + p * (high - low)))).clamp(*lower, *upper)
            }
            Self::Triangular { lower, mode, upper } => {
                let (width, left) = (upper - lower, mode - lower);
                if p * width < left {
                    lower + (p * width * left).sqrt()
                } else {
                    upper - ((1.0 - p) * width * (upper - mode)).sqrt()
                }
            }
            Self::Beta { alpha, beta, lower, upper } => {
                let share = beta_quantile(p, *alpha, *beta);
                (1.0 - share) * lower + share * upper
            }
            Self::Table(points) => table_quantile(points, &table_mass(points), p),
        }
    }

    /// The share of the law below x.
    pub fn cdf(&self, x: f64) -> f64 {
        let share = |lower: f64, upper: f64| ((x - lower) / (upper - lower)).clamp(0.0, 1.0);
        match self {
            Self::Uniform { lower, upper } => share(*lower, *upper),
            Self::Normal { mean, sigma } => normal_cdf((x - mean) / sigma),
            Self::TruncatedNormal { mean, sigma, lower, upper } => {
                let at = |x: f64| normal_cdf((x - mean) / sigma);
                ((at(x.clamp(*lower, *upper)) - at(*lower)) / (at(*upper) - at(*lower))).clamp(0.0, 1.0)
            }
            Self::Lognormal { median, sigma, lower, upper } => {
                let at = |x: f64| if x > 0.0 { normal_cdf(math::ln(x / median) / sigma) } else { 0.0 };
                ((at(x.clamp(*lower, *upper)) - at(*lower)) / (at(*upper) - at(*lower))).clamp(0.0, 1.0)
            }
            Self::Triangular { lower, mode, upper } => {
                let x = x.clamp(*lower, *upper);
                if x < *mode {
                    (x - lower) * (x - lower) / ((upper - lower) * (mode - lower))
                } else {
                    1.0 - (upper - x) * (upper - x) / ((upper - lower) * (upper - mode)).max(f64::MIN_POSITIVE)
                }
            }
            Self::Beta { alpha, beta, lower, upper } => beta_cdf(share(*lower, *upper), *alpha, *beta),
            Self::Table(points) => {
                let total = table_mass(points).last().copied().unwrap_or(1.0);
                table_below(points, x) / total
            }
        }
    }

    /// Mean.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Uniform { lower, upper } => 0.5 * (lower + upper),
            Self::Normal { mean, .. } => *mean,
            Self::TruncatedNormal { mean, sigma, lower, upper } => {
                let (_, first, _) = truncated(*mean, *sigma, *lower, *upper);
                mean + sigma * first
            }
            Self::Lognormal { .. } => self.log_moment(1.0),
            Self::Triangular { lower, mode, upper } => (lower + mode + upper) / 3.0,
            Self::Beta { alpha, beta, lower, upper } => lower + (upper - lower) * alpha / (alpha + beta),
            Self::Table(points) => {
                let total = table_mass(points).last().copied().unwrap_or(1.0);
                moment(points, |x| x) / total
            }
        }
    }

    /// Standard deviation.
    pub fn deviation(&self) -> f64 {
        match self {
            Self::Uniform { lower, upper } => (upper - lower) / 12.0_f64.sqrt(),
            Self::Normal { sigma, .. } => *sigma,
            Self::TruncatedNormal { mean, sigma, lower, upper } => {
                let (_, first, second) = truncated(*mean, *sigma, *lower, *upper);
                sigma * (1.0 + second - first * first).max(0.0).sqrt()
            }
            Self::Lognormal { .. } => {
                let mean = self.log_moment(1.0);
                (self.log_moment(2.0) - mean * mean).max(0.0).sqrt()
            }
            Self::Triangular { lower, mode, upper } => {
                let (a, b, c) = (lower, upper, mode);
                ((a * a + b * b + c * c - a * b - a * c - b * c) / 18.0).max(0.0).sqrt()
            }
            Self::Beta { alpha, beta, lower, upper } => {
                let sum = alpha + beta;
                (upper - lower) * (alpha * beta / (sum + 1.0)).sqrt() / sum
            }
            Self::Table(points) => {
                let total = table_mass(points).last().copied().unwrap_or(1.0);
                let mean = self.mean();
                (moment(points, |x| (x - mean) * (x - mean)) / total).max(0.0).sqrt()
            }
        }
    }

    /// The mean of a lognormal law's powers; zero of others.
    fn log_moment(&self, power: f64) -> f64 {
        let Self::Lognormal { median, sigma, lower, upper } = self else { return 0.0 };
        let [low, high] = log_scores(*median, *sigma, *lower, *upper);
        let between = |shift: f64| normal_cdf(high - shift) - normal_cdf(low - shift);
        let spread = power * sigma;
        math::pow(*median, power) * math::exp(0.5 * spread * spread) * between(spread) / between(0.0)
    }

    /// Share of the law outside of an interval.
    pub fn outside(&self, lower: f64, upper: f64) -> f64 {
        match self {
            Self::Normal { mean, sigma } => normal_cdf((lower - mean) / sigma) + normal_cdf((mean - upper) / sigma),
            Self::Lognormal { median, sigma, .. } => {
                // A part that was cut off does not lie outside.
                let [low, high] = log_scores(*median, *sigma, lower, upper);
                let cut = |score: f64, end: f64| if end > 0.0 && end.is_finite() { 0.0 } else { normal_cdf(score) };
                let Self::Lognormal { lower: least, upper: most, .. } = self else { return 0.0 };
                cut(low, *least) + cut(-high, *most)
            }
            _ => 0.0,
        }
    }

    /// Name in files and tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Uniform { .. } => "uniform",
            Self::Normal { .. } => "normal",
            Self::TruncatedNormal { .. } => "truncated_normal",
            Self::Lognormal { .. } => "lognormal",
            Self::Triangular { .. } => "triangular",
            Self::Beta { .. } => "beta",
            Self::Table(_) => "table",
        }
    }
}

/// Normal scores of a lognormal law's ends.
fn log_scores(median: f64, sigma: f64, lower: f64, upper: f64) -> [f64; 2] {
    let low = if lower > 0.0 { math::ln(lower / median) / sigma } else { f64::NEG_INFINITY };
    let high = if upper.is_finite() { math::ln(upper / median) / sigma } else { f64::INFINITY };
    [low, high]
}

/// Mass of a truncated standard normal law, and Σ of the boundary terms of its first and second moments.
fn truncated(mean: f64, sigma: f64, lower: f64, upper: f64) -> (f64, f64, f64) {
    let [low, high] = [lower, upper].map(|end| (end - mean) / sigma);
    let density = |x: f64| math::exp(-0.5 * x * x) / (2.0 * std::f64::consts::PI).sqrt();
    let mass = normal_cdf(high) - normal_cdf(low);
    (mass, (density(low) - density(high)) / mass, (low * density(low) - high * density(high)) / mass)
}

/// The mass up to each point, not normalised.
pub(super) fn table_mass(points: &[(f64, f64)]) -> Vec<f64> {
    let mut mass = vec![0.0];
    for pair in points.windows(2) {
        let last = mass[mass.len() - 1];
        mass.push(last + 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1));
    }
    mass
}

/// The mass below x, not normalised.
fn table_below(points: &[(f64, f64)], x: f64) -> f64 {
    let mut below = 0.0;
    for pair in points.windows(2) {
        let [(from, low), (to, high)] = [pair[0], pair[1]];
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        below += (to - from) * t * (low + 0.5 * t * (high - low));
    }
    below
}

/// The value below which a share p lies, of a table with this mass up to each point.
pub(super) fn table_quantile(points: &[(f64, f64)], mass: &[f64], p: f64) -> f64 {
    let wanted = p * mass[mass.len() - 1];
    let index = mass.partition_point(|&below| below < wanted).clamp(1, points.len() - 1);
    let [(from, low), (to, high)] = [points[index - 1], points[index]];
    let rest = (wanted - mass[index - 1]).max(0.0) / (to - from);
    // low t + (high − low) t²/2 = rest, without loss of digits where the density is nearly even.
    let root = (low * low + 2.0 * (high - low) * rest).max(0.0).sqrt();
    let t = if low + root > 0.0 { 2.0 * rest / (low + root) } else { 1.0 };
    from + (to - from) * t.clamp(0.0, 1.0)
}

/// ∫ f times the density, by Gauss's two points in each piece: exact for f up to the second power.
fn moment(points: &[(f64, f64)], f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 / 3.0_f64.sqrt();
    let of_pair = |pair: &[(f64, f64)]| {
        let [(from, low), (to, high)] = [pair[0], pair[1]];
        let at = |t: f64| f(from + t * (to - from)) * (low + t * (high - low));
        0.5 * (to - from) * (at(0.5 - half) + at(0.5 + half))
    };
    points.windows(2).map(of_pair).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<Distribution> {
        let (lower, upper) = (-1.0, 3.0);
        vec![
            Distribution::Uniform { lower, upper },
            Distribution::Normal { mean: 0.5, sigma: 0.7 },
            Distribution::TruncatedNormal { mean: 0.0, sigma: 1.0, lower, upper },
            Distribution::TruncatedNormal { mean: -6.0, sigma: 1.0, lower, upper },
            Distribution::Lognormal { median: 0.8, sigma: 0.3, lower: 0.0, upper: f64::INFINITY },
            Distribution::Lognormal { median: 0.8, sigma: 0.3, lower: 0.5, upper: 1.5 },
            Distribution::Triangular { lower, mode: 0.0, upper },
            Distribution::Triangular { lower, mode: -1.0, upper },
            Distribution::Beta { alpha: 2.0, beta: 5.0, lower, upper },
            Distribution::Table(vec![(-1.0, 0.0), (0.0, 2.0), (1.0, 2.0), (3.0, 1.0)]),
        ]
    }

    #[test]
    fn quantiles_invert_laws_and_have_their_moments() {
        for law in laws() {
            let count = 200_000;
            let (mut sum, mut squares) = (0.0, 0.0);
            let mean = law.mean();
            for i in 0..count {
                let p = (f64::from(i) + 0.5) / f64::from(count);
                let x = law.quantile(p);
                sum += x;
                squares += (x - mean) * (x - mean);
                if i % 1000 == 0 {
                    assert!((law.cdf(x) - p).abs() < 1e-9, "{law:?} {p} {x} {}", law.cdf(x));
                }
            }
            let n = f64::from(count);
            assert!((sum / n - mean).abs() < 1e-5, "{law:?}: {} {mean}", sum / n);
            assert!(((squares / n).sqrt() - law.deviation()).abs() < 1e-4, "{law:?}");
        }
    }

    #[test]
    fn published_moments() {
        // A triangular law of ends 0 and 1 and mode ½ has variance 1/24; a beta law of 2 and 5 has 5/196.
        let triangular = Distribution::Triangular { lower: 0.0, mode: 0.5, upper: 1.0 };
        assert!((triangular.deviation() - (1.0_f64 / 24.0).sqrt()).abs() < 1e-15);
        let beta = Distribution::Beta { alpha: 2.0, beta: 5.0, lower: 0.0, upper: 1.0 };
        assert!((beta.deviation() - (5.0_f64 / 196.0).sqrt()).abs() < 1e-15);
        // A lognormal law of median m has mean m e^(σ²/2) and variance m² e^σ² (e^σ² − 1).
        let law = Distribution::Lognormal { median: 2.0, sigma: 0.5, lower: 0.0, upper: f64::INFINITY };
        assert!((law.mean() - 2.0 * 0.125_f64.exp()).abs() < 1e-14);
        assert!((law.deviation() - 2.0 * (0.25_f64.exp() * 0.25_f64.exp_m1()).sqrt()).abs() < 1e-13);
        assert!(
            (law.outside(2.0 * (-3.0_f64).exp(), 2.0 * 3.0_f64.exp()) / 1.973_175_290_075_396e-9 - 1.0).abs() < 1e-12
        );
        // Six sigma on both sides: 2 · 9.8659e-10.
        let normal = Distribution::Normal { mean: 0.0, sigma: 1.0 };
        assert!((normal.outside(-6.0, 6.0) / 1.973_175_290_075_396e-9 - 1.0).abs() < 1e-12);
    }
}
