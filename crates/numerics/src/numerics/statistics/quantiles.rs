//! Quantiles of a law, prepared for many samples.

use symdiff::math;

use super::distribution::{Distribution, table_mass, table_quantile};
use super::special::{normal_cdf, normal_quantile};
use super::tuning::TUNING;

/// Quantiles of a law.
#[derive(Clone, Debug)]
pub struct Quantiles {
    distribution: Distribution,
    by: By,
}

#[derive(Clone, Debug)]
enum By {
    /// Its own formula.
    Formula,
    /// Values and slopes over normal scores, with cubics between: those of beta laws are smooth there.
    Cubics(Vec<(f64, f64)>),
    /// The mass up to each point of a table.
    Mass(Vec<f64>),
}

impl Quantiles {
    /// Prepares the quantiles of a law.
    pub fn new(distribution: &Distribution) -> Self {
        let by = match distribution {
            Distribution::Beta { .. } => {
                let of = |score: f64| distribution.quantile(normal_cdf(score));
                let point = |number: i32| {
                    let score = f64::from(number) / f64::from(TUNING.per_score);
                    (
                        of(score),
                        (of(score + TUNING.step_of_table) - of(score - TUNING.step_of_table))
                            / (2.0 * TUNING.step_of_table),
                    )
                };
                By::Cubics(
                    (-TUNING.farthest_score * TUNING.per_score..=TUNING.farthest_score * TUNING.per_score)
                        .map(point)
                        .collect(),
                )
            }
            Distribution::Table(points) => By::Mass(table_mass(points)),
            _ => By::Formula,
        };
        Self { distribution: distribution.clone(), by }
    }

    /// The value below which a share p, 0 < p < 1, of the law lies.
    pub fn of_share(&self, p: f64) -> f64 {
        match (&self.by, &self.distribution) {
            (By::Mass(mass), Distribution::Table(points)) => table_quantile(points, mass, p),
            (By::Cubics(_), _) => self.of_score(normal_quantile(p)),
            _ => self.distribution.quantile(p),
        }
    }

    /// The value that has this normal score.
    pub fn of_score(&self, score: f64) -> f64 {
        let By::Cubics(points) = &self.by else {
            return match self.distribution {
                Distribution::Normal { mean, sigma } => mean + sigma * score,
                Distribution::Lognormal { median, sigma, lower: 0.0, upper: f64::INFINITY } => {
                    median * math::exp(sigma * score)
                }
                _ => self.of_share(normal_cdf(score)),
            };
        };
        let end = f64::from(TUNING.farthest_score);
        let along = (score.clamp(-end, end) + end) * f64::from(TUNING.per_score);
        let index = (along as usize).min(points.len() - 2);
        let t = along - index as f64;
        let [(from, rise), (to, fall)] = [points[index], points[index + 1]];
        let [rise, fall] = [rise, fall].map(|slope| slope / f64::from(TUNING.per_score));
        let change = to - from;
        from + t * (rise + t * (3.0 * change - 2.0 * rise - fall + t * (rise + fall - 2.0 * change)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prepared_quantiles_match_the_law() {
        let table = vec![(-1.0, 0.0), (0.0, 2.0), (1.0, 2.0), (3.0, 1.0)];
        let laws = [
            Distribution::Beta { alpha: 0.9, beta: 2.2, lower: -1.0, upper: 3.0 },
            Distribution::Beta { alpha: 2.5, beta: 1.5, lower: -1.0, upper: 3.0 },
            Distribution::Beta { alpha: 40.0, beta: 0.5, lower: -1.0, upper: 3.0 },
            Distribution::Table(table),
            Distribution::Lognormal { median: 1.0, sigma: 0.2, lower: 0.0, upper: f64::INFINITY },
        ];
        for law in laws {
            let prepared = Quantiles::new(&law);
            for number in 1..2000 {
                let p = f64::from(number) / 2000.0;
                let (own, wanted) = (prepared.of_share(p), law.quantile(p));
                assert!((own - wanted).abs() < 1e-7, "{law:?} {p}: {own} {wanted}");
                let by_score = prepared.of_score(normal_quantile(p));
                assert!((by_score - wanted).abs() < 1e-7, "{law:?} {p}: {by_score} {wanted}");
            }
        }
    }

    /// By scipy 1.17.1: `beta.ppf` and `lognorm.ppf`.
    #[test]
    fn prepared_quantiles_match_scipy() {
        let shares = [1e-6, 0.001, 0.05, 0.5, 0.95, 0.999];
        let beta = |alpha, beta| Distribution::Beta { alpha, beta, lower: 0.0, upper: 1.0 };
        let lognormal = Distribution::Lognormal { median: 2e5, sigma: 0.1, lower: 0.0, upper: f64::INFINITY };
        let of_beta = [
            (
                beta(0.9, 2.2),
                [
                    9.579_791_806_036e-8,
                    0.000_206_417_255_243_7,
                    0.016_101_485_361_352_7,
                    0.241_904_509_018_187_2,
                    0.726_532_986_953_363_3,
                    0.953_422_657_754_447_7,
                ],
            ),
            (
                beta(2.5, 1.5),
                [
                    0.002_996_222_488_947_2,
                    0.047_797_770_513_992,
                    0.235_534_041_442_621_9,
                    0.647_547_720_122_869,
                    0.937_587_476_142_084_9,
                    0.995_561_474_311_724_1,
                ],
            ),
            (
                beta(60.0, 40.0),
                [
                    0.365_451_243_274_441,
                    0.446_188_241_964_063_6,
                    0.518_636_636_728_434_1,
                    0.600_669_257_301_867_3,
                    0.679_077_343_447_286_1,
                    0.742_619_908_044_877_4,
                ],
            ),
        ];
        for (law, values) in of_beta {
            let prepared = Quantiles::new(&law);
            for (share, value) in shares.into_iter().zip(values) {
                assert!((law.quantile(share) - value).abs() < 1e-12, "{law:?} {share}: {}", law.quantile(share));
                assert!(
                    (prepared.of_share(share) - value).abs() < 1e-9,
                    "{law:?} {share}: {}",
                    prepared.of_share(share)
                );
            }
        }
        let prepared = Quantiles::new(&lognormal);
        for (share, value) in
            [(0.001, 146_832.742_950_449_96), (0.05, 169_666.034_824_167_32), (0.999, 272_418.802_483_982_5)]
        {
            assert!((prepared.of_share(share) / value - 1.0).abs() < 1e-13, "{share}: {}", prepared.of_share(share));
        }
        assert!((lognormal.mean() / 201_002.504_171_880_2 - 1.0).abs() < 1e-13);
        assert!((lognormal.deviation() / 20_150.605_889_240_79 - 1.0).abs() < 1e-13);
    }
}
