//! Quantiles of a law, prepared for many samples.

use symdiff::math;

use super::distribution::{Distribution, table_mass, table_quantile};
use super::special::{normal_cdf, normal_quantile};

/// Normal scores between which a law without a closed quantile is tabulated, and intervals to a score.
const FARTHEST: i32 = 9;
const PER_SCORE: i32 = 64;

/// Half a step for slopes at the table's points.
const STEP: f64 = 1e-4;

/// What gives a law's values.
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
    /// Of a law.
    pub fn new(distribution: &Distribution) -> Self {
        let by = match distribution {
            Distribution::Beta { .. } => {
                let of = |score: f64| distribution.quantile(normal_cdf(score));
                let point = |number: i32| {
                    let score = f64::from(number) / f64::from(PER_SCORE);
                    (of(score), (of(score + STEP) - of(score - STEP)) / (2.0 * STEP))
                };
                By::Cubics((-FARTHEST * PER_SCORE..=FARTHEST * PER_SCORE).map(point).collect())
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
        let end = f64::from(FARTHEST);
        let along = (score.clamp(-end, end) + end) * f64::from(PER_SCORE);
        let place = (along as usize).min(points.len() - 2);
        let t = along - place as f64;
        let [(from, rise), (to, fall)] = [points[place], points[place + 1]];
        let [rise, fall] = [rise, fall].map(|slope| slope / f64::from(PER_SCORE));
        let change = to - from;
        from + t * (rise + t * (3.0 * change - 2.0 * rise - fall + t * (rise + fall - 2.0 * change)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prepared_quantiles_are_those_of_the_law() {
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
}
