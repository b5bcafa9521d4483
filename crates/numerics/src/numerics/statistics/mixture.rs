//! Mixture of normal laws about places where something fails, and of the law itself: points of the mixture, each with
//! the ratio of the densities.

use super::points::replicate;
use super::special::normal_quantile;
use super::tuning::TUNING;
use crate::numerics::dot;
use symdiff::math;

/// Places in independent normal scores about which points are drawn (T. Hesterberg, Technometrics 37 (1995) 185).
#[derive(Clone, Debug, Default)]
pub struct Mixture {
    places: Vec<Vec<f64>>,
}

impl Mixture {
    /// Adds a place, unless one is near or there are `most` already.
    pub fn add(&mut self, place: Vec<f64>, most: usize) {
        let is_new = |known: &Vec<f64>| distance(known, &place) > TUNING.places_apart;
        if self.places.len() < most && self.places.iter().all(is_new) {
            self.places.push(place);
        }
    }

    /// Number of places.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// Whether there is no place: points are then of the law itself.
    pub fn is_plain(&self) -> bool {
        self.places.is_empty()
    }

    /// One replicate's `count` points in `k` dimensions, and their weights.
    pub fn replicate(&self, number: usize, k: usize, count: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
        let numbers = replicate(number, k + 1, count);
        let points: Vec<Vec<f64>> = numbers.chunks_exact(k + 1).map(|numbers| self.drawn(numbers)).collect();
        let weights = points.iter().map(|point| self.weight(point)).collect();
        (points, weights)
    }

    /// A point from evenly spread numbers: the first selects the place.
    fn drawn(&self, numbers: &[f64]) -> Vec<f64> {
        let about = (numbers[0] - TUNING.defensive) / (1.0 - TUNING.defensive) * self.places.len() as f64;
        let place =
            if about >= 0.0 { self.places.get((about as usize).min(self.places.len().max(1) - 1)) } else { None };
        let score = |(axis, &p): (usize, &f64)| normal_quantile(p) + place.map_or(0.0, |place| place[axis]);
        numbers[1..].iter().enumerate().map(score).collect()
    }

    /// The law's density over the mixture's.
    pub fn weight(&self, point: &[f64]) -> f64 {
        if self.is_plain() {
            return 1.0;
        }
        let each = (1.0 - TUNING.defensive) / self.places.len() as f64;
        let ratio = |place: &Vec<f64>| each * math::exp(dot(point, place) - 0.5 * dot(place, place));
        1.0 / (TUNING.defensive + self.places.iter().map(ratio).sum::<f64>())
    }
}

/// Value and slopes of a function of normal scores, by central differences.
pub(super) fn value_and_slopes(at: &[f64], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> (f64, Vec<f64>) {
    let mut points = vec![at.to_vec()];
    for axis in 0..at.len() {
        for step in [TUNING.step_of_scores, -TUNING.step_of_scores] {
            let mut point = at.to_vec();
            point[axis] += step;
            points.push(point);
        }
    }
    let values = slack(&points);
    let slope = |axis: usize| (values[2 * axis + 1] - values[2 * axis + 2]) / (2.0 * TUNING.step_of_scores);
    (values[0], (0..at.len()).map(slope).collect())
}

/// The point at this distance from the middle at which least is left, as far as can be seen from the start (S. R.
/// Winterstein et al., Environmental parameters for extreme response: inverse FORM, ICOSSAR 1993, 551).
pub fn least_at_distance(start: &[f64], radius: f64, slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Vec<f64>> {
    let onto = |point: &[f64]| -> Option<Vec<f64>> {
        let length = dot(point, point).sqrt();
        (length > 0.0 && length.is_finite()).then(|| point.iter().map(|x| radius / length * x).collect())
    };
    let mut best: Option<(f64, Vec<f64>)> = None;
    let (mut at, mut stride) = (onto(start)?, TUNING.longest_step);
    for _ in 0..TUNING.steps_to_likeliest {
        let (value, slopes) = value_and_slopes(&at, slack);
        let wanted = onto(&slopes.iter().map(|slope| -slope).collect::<Vec<_>>());
        match &best {
            // Too far: back, with a shorter step.
            Some((least, before)) if value >= *least => {
                stride *= 0.5;
                at = onto(&at.iter().zip(before).map(|(a, b)| 0.5 * (a + b)).collect::<Vec<_>>())?;
                if stride < TUNING.step_of_scores {
                    break;
                }
                continue;
            }
            _ => best = Some((value, at.clone())),
        }
        let Some(wanted) = wanted else { break };
        let length = distance(&wanted, &at);
        if length < TUNING.step_of_scores {
            break;
        }
        let share = (stride / length).min(1.0);
        let moved: Vec<f64> = at.iter().zip(&wanted).map(|(at, wanted)| at + share * (wanted - at)).collect();
        at = onto(&moved)?;
    }
    best.filter(|(value, _)| value.is_finite()).map(|(_, place)| place)
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Numbers of values in rising order, each with the share of the law up to its middle.
pub fn shares_below(values: &[f64], weights: &[f64]) -> Vec<(usize, f64)> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
    let mut below = 0.0;
    let each = 1.0 / values.len() as f64;
    let middle = |number: usize| {
        let own = each * weights[number];
        below += own;
        (number, below - 0.5 * own)
    };
    order.into_iter().map(middle).collect()
}

/// The value below which this share of the law lies, linearly between the values' middles.
pub fn weighted_quantile(values: &[f64], weights: &[f64], share: f64) -> f64 {
    if values.iter().any(|value| value.is_nan()) {
        return f64::NAN;
    }
    let shares = shares_below(values, weights);
    let above = shares.partition_point(|(_, below)| *below < share);
    match (above.checked_sub(1).map(|index| shares[index]), shares.get(above)) {
        (Some((low, a)), Some(&(high, b))) => values[low] + (share - a) / (b - a) * (values[high] - values[low]),
        (Some((only, _)), None) | (None, Some(&(only, _))) => values[only],
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::super::points::REPLICATES;
    use super::super::special::normal_cdf;
    use super::*;

    #[test]
    fn quantiles_of_tails() {
        // β − n·z has β + Φ⁻¹(p) as its quantile.
        let direction = [0.6, 0.0, -0.8];
        let value = |points: &[Vec<f64>]| points.iter().map(|z| 1.0 - dot(z, &direction)).collect::<Vec<f64>>();
        for beta in [2.0, 3.0, 4.75] {
            let place = least_at_distance(&[1.0, 1.0, 0.2], beta, &value).unwrap();
            assert!(distance(&place, &direction.map(|x| beta * x)) < 0.05, "{place:?}");
            let mut mixture = Mixture::default();
            mixture.add(place.clone(), 2);
            mixture.add(place, 2);
            assert_eq!(mixture.places.len(), 1);
            let (mut values, mut weights) = (Vec::new(), Vec::new());
            for number in 0..REPLICATES {
                let (points, own) = mixture.replicate(number, 3, 1 << 11);
                values.extend(value(&points));
                weights.extend(own);
            }
            let found = weighted_quantile(&values, &weights, normal_cdf(-beta));
            assert!((found - (1.0 - beta)).abs() < 3e-3, "{beta} {found}");
        }
    }

    #[test]
    fn quantiles_of_equal_weights_match_unweighted_ones() {
        let values = [4.0, 1.0, 3.0, 2.0];
        let found = [0.0, 0.125, 0.25, 0.5, 1.0].map(|p| weighted_quantile(&values, &[1.0; 4], p));
        assert_eq!(found, [1.0, 1.0, 1.5, 2.5, 4.0]);
    }

    #[test]
    fn a_curved_limit_has_its_nearest_point() {
        // Least on the sphere of 4 − x² − y at distance 2 is where x² + y is most: y = 1/2.
        let value = |points: &[Vec<f64>]| points.iter().map(|z| 4.0 - z[0] * z[0] - z[1]).collect::<Vec<f64>>();
        let place = least_at_distance(&[0.5, 1.9], 2.0, &value).unwrap();
        assert!((place[1] - 0.5).abs() < 0.05 && place[0] > 0.0, "{place:?}");
    }
}
