//! Shares that are so small that few samples see them: by importance sampling about the likeliest points that fail, by
//! directional sampling, or by subset simulation, whichever is most accurate; each is compared with the points that
//! subset simulation finds to fail.

use super::estimates::{Estimate, STUDENT};
use super::mixture::{Mixture, distance, value_and_slopes};
use super::points::{REPLICATES, replicate};
use super::rays::{Slacks, direction, shares_along, unit};
use super::subset::{Subset, subset};
use super::tuning::TUNING;
use crate::numerics::dot;

/// Method by which a share was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RareMethod {
    /// Samples about the likeliest points that fail.
    Importance,
    /// Rays from the middle.
    Directional,
    /// Chains, level by level.
    Subset,
}

impl RareMethod {
    /// Printed name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Importance => "importance sampling",
            Self::Directional => "directional sampling",
            Self::Subset => "subset simulation",
        }
    }
}

/// A small share that fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RareShare {
    /// The share.
    pub value: f64,
    /// Its 95 % confidence interval, from the failures if errors help to those if errors harm; unknown (NaN) if methods
    /// contradict one another.
    pub interval: [f64; 2],
    /// The method that found it.
    pub method: RareMethod,
    /// Samples that this took.
    pub samples: usize,
}

/// Estimates for slacks that errors help, as they are, and that errors harm.
type Estimates = [Estimate; 3];

/// The least of several slacks at each point, each in its own scale, with errors that help, none, and errors that harm;
/// NaN if one is unknown. `values` are slack by slack, point by point.
pub fn least_slacks(values: &[f64], errors: &[f64], scales: &[f64]) -> Vec<[f64; 3]> {
    let count = values.len() / errors.len().max(1);
    let mut least = vec![[f64::INFINITY; 3]; count];
    for ((values, error), scale) in values.chunks_exact(count.max(1)).zip(errors).zip(scales) {
        for (least, value) in least.iter_mut().zip(values) {
            for (least, sign) in least.iter_mut().zip([-1.0, 0.0, 1.0]) {
                let slack = (value - sign * error) / scale;
                if slack < *least || slack.is_nan() {
                    *least = slack;
                }
            }
        }
    }
    least
}

/// The share with a negative slack; `None` if nothing is found to fail. `slacks` has the values of points in
/// independent normal scores, with errors that help, none, and errors that harm; `starts` are points from which the
/// search for places that fail begins.
pub fn rare_share(starts: &[Vec<f64>], slacks: &Slacks) -> Option<RareShare> {
    let k = starts.first()?.len();
    let count = std::cell::Cell::new(0);
    let counted = |points: &[Vec<f64>]| {
        count.set(count.get() + points.len());
        slacks(points)
    };
    let slack = |points: &[Vec<f64>]| counted(points).into_iter().map(|[_, own, _]| own).collect::<Vec<f64>>();
    let seen = subset(k, &slack);
    let mut mixture = Mixture::default();
    starts.iter().filter_map(|start| likeliest(start, &slack)).for_each(|place| mixture.add(place, TUNING.places));
    let Some(seen) = seen else {
        // Nothing to compare it with: farther out than chains come.
        let found = (!mixture.is_plain()).then(|| by_importance(&mixture, k, &counted))?;
        return Some(shared(found, RareMethod::Importance, count.get()));
    };
    let level = Estimate::of(&seen.shares);
    let level = Estimate { sampling: TUNING.dependent_chains * level.sampling, ..level };
    let mut best = Best(RareMethod::Directional, by_directions(k, &seen, level.value, &counted));
    if !best.is_close() && !mixture.is_plain() {
        let found = by_importance(&mixture, k, &counted);
        best.consider(RareMethod::Importance, foreseen(found, of_weights(&mixture, &seen, level.value)));
    }
    if !best.is_close() && cover(&mut mixture, &seen, level.value, &slack) {
        let found = by_importance(&mixture, k, &counted);
        best.consider(RareMethod::Importance, foreseen(found, of_weights(&mixture, &seen, level.value)));
    }
    if !best.is_close() {
        // Errors change the share in the same ratio as with the other estimates.
        let base = best.1[1].value;
        let change = best.1.map(|other| if base > 0.0 { other.value / base } else { f64::NAN });
        let of = |change: f64| Estimate { value: change * level.value, sampling: change * level.sampling };
        best.consider(RareMethod::Subset, change.map(of));
    }
    let Best(method, found) = best;
    let mut share = shared(found, method, count.get());
    let apart = (found[1].value - level.value).abs();
    if apart > TUNING.intervals_apart * (level.sampling + found[1].sampling) || apart.is_nan() {
        share.interval = [f64::NAN; 2];
    }
    Some(share)
}

fn shared([better, own, worse]: Estimates, method: RareMethod, samples: usize) -> RareShare {
    let interval = [(better.value - better.sampling).max(0.0), (worse.value + worse.sampling).min(1.0)];
    RareShare { value: own.value, interval, method, samples }
}

/// The estimates with the smallest relative error so far.
struct Best(RareMethod, Estimates);

impl Best {
    fn is_close(&self) -> bool {
        self.1[1].sampling <= TUNING.close * self.1[1].value
    }

    fn consider(&mut self, method: RareMethod, found: Estimates) {
        let width = |found: &Estimates| found[1].sampling / found[1].value;
        // An estimate of zero has no relative error (NaN), and any other replaces it.
        if width(&found) < width(&self.1) || width(&self.1).is_nan() {
            *self = Self(method, found);
        }
    }
}

/// Estimates of the three slacks from shares of replicates.
fn estimates(of_replicate: &[[f64; 3]]) -> Estimates {
    [0, 1, 2].map(|which| Estimate::of(&of_replicate.iter().map(|shares| shares[which]).collect::<Vec<_>>()))
}

/// Estimates from samples of a mixture of normal laws about places that fail and of the law itself.
fn by_importance(mixture: &Mixture, k: usize, slacks: &Slacks) -> Estimates {
    let of_replicate = |number: usize| {
        let (points, weights) = mixture.replicate(number, k, TUNING.points);
        let values = slacks(&points);
        // NaN fails.
        let share = |which: usize| {
            let fails = weights.iter().zip(&values).filter(|(_, value)| value[which] < 0.0 || value[which].is_nan());
            fails.map(|(weight, _)| weight).sum::<f64>() / TUNING.points as f64
        };
        [0, 1, 2].map(share)
    };
    estimates(&(0..REPLICATES).map(of_replicate).collect::<Vec<_>>())
}

/// The deviation about the share, relative to it, that failing points foresee if the mixture does not cover some of
/// them: such samples do not show it themselves. The mean square of all weights is the share times the mean weight of
/// failing points. If all are covered, evenly spread points do better, and their replicates give the error.
fn of_weights(mixture: &Mixture, seen: &Subset, share: f64) -> f64 {
    let weights: Vec<f64> = seen.failing.iter().map(|point| mixture.weight(point)).collect();
    if weights.iter().all(|weight| *weight < TUNING.uncovered * share) {
        return 0.0;
    }
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    (mean / share - 1.0).max(0.0).sqrt() / ((REPLICATES * TUNING.points) as f64).sqrt()
}

/// Estimates with deviations that are at least those foreseen of random points.
fn foreseen(found: Estimates, deviation: f64) -> Estimates {
    found.map(|of| Estimate {
        sampling: (TUNING.narrowest_widened * of.sampling).max(STUDENT * deviation * of.value),
        ..of
    })
}

/// Estimates by rays from the middle.
fn by_directions(k: usize, seen: &Subset, share: f64, slacks: &Slacks) -> Estimates {
    let of_replicate = |number: usize| {
        let numbers = replicate(number, k, TUNING.directions);
        let directions: Vec<Vec<f64>> = numbers.chunks_exact(k).map(direction).collect();
        let shares = shares_along(&directions, slacks);
        [0, 1, 2].map(|which| shares.iter().map(|own| own[which]).sum::<f64>() / TUNING.directions as f64)
    };
    let found = estimates(&(0..REPLICATES).map(of_replicate).collect::<Vec<_>>());
    let every = seen.failing.len().div_ceil(TUNING.toward_failing);
    let toward: Vec<Vec<f64>> = seen.failing.iter().step_by(every).map(|point| unit(point)).collect();
    let along = shares_along(&toward, slacks);
    let mean = along.iter().map(|own| own[1]).sum::<f64>() / along.len() as f64;
    let found = found.map(|of| Estimate { sampling: of.sampling + TUNING.along_ray * of.value, ..of });
    foreseen(found, (mean / share - 1.0).max(0.0).sqrt() / ((REPLICATES * TUNING.directions) as f64).sqrt())
}

/// Adds places until the mixture covers all points that fail. Returns whether one was added.
fn cover(mixture: &mut Mixture, seen: &Subset, share: f64, slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> bool {
    let before = mixture.count();
    let mut skipped = vec![false; seen.failing.len()];
    for _ in 0..2 * TUNING.most_places {
        let weights = seen.failing.iter().map(|point| mixture.weight(point));
        let left = weights.enumerate().filter(|(index, _)| !skipped[*index]);
        let Some((far, weight)) = left.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if weight < TUNING.uncovered * share || mixture.count() >= TUNING.most_places {
            break;
        }
        skipped[far] = true;
        if let Some(index) = likeliest(&seen.failing[far], slack) {
            mixture.add(index, TUNING.most_places);
        }
    }
    mixture.count() > before
}

/// The point nearest to the middle, as far as can be seen from the start, at which the slack is zero.
fn likeliest(start: &[f64], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Vec<f64>> {
    let mut at = start.to_vec();
    let scale = slack(&[vec![0.0; at.len()]])[0].abs();
    for _ in 0..TUNING.steps_to_likeliest {
        let (value, slopes) = value_and_slopes(&at, slack);
        let squared = dot(&slopes, &slopes);
        if squared == 0.0 || !squared.is_finite() {
            return None;
        }
        let along = (dot(&slopes, &at) - value) / squared;
        let wanted: Vec<f64> = slopes.iter().map(|slope| along * slope).collect();
        let length = distance(&wanted, &at);
        if length < 1e-3 && value.abs() < 1e-3 * scale {
            break;
        }
        let share = (TUNING.longest_step / length).min(1.0);
        at.iter_mut().zip(&wanted).for_each(|(at, wanted)| *at += share * (wanted - *at));
    }
    let found = slack(std::slice::from_ref(&at))[0];
    (dot(&at, &at) < TUNING.farthest_likeliest * TUNING.farthest_likeliest && found <= 0.1 * scale).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::super::normals::{Normals, farther_than};
    use super::super::special::normal_cdf;
    use super::*;

    type Slack = dyn Fn(&[f64]) -> f64;

    /// The share of a slack without errors.
    fn found(starts: &[Vec<f64>], slack: &dyn Fn(&[f64]) -> f64) -> Option<RareShare> {
        rare_share(starts, &|points: &[Vec<f64>]| points.iter().map(|z| [slack(z); 3]).collect())
    }

    /// Points with the least slack among random points of the law itself.
    fn starts(k: usize, slack: &dyn Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
        let mut normals = Normals::new(77);
        let mut points: Vec<Vec<f64>> = (0..4000).map(|_| normals.draw(k)).collect();
        points.sort_by(|a, b| slack(a).total_cmp(&slack(b)));
        points.truncate(12);
        points
    }

    #[test]
    fn tails_beyond_all_samples_are_estimated() {
        for beta in [4.0, 5.5, 7.0] {
            // Φ(−β) along one direction, and twice that where both sides fail.
            let direction = [0.6, 0.0, 0.8];
            let share = found(&[vec![1.0, 0.1, 1.0]], &|z| beta - dot(z, &direction)).unwrap();
            let truth = normal_cdf(-beta);
            let [low, high] = share.interval;
            assert!(low <= truth && truth <= high && high - low < 0.05 * truth, "{beta} {share:?} {truth}");
            let two = found(&[vec![1.0, 0.1, 1.0], vec![-1.0, 0.0, -1.0]], &|z| beta - dot(z, &direction).abs());
            let two = two.unwrap();
            assert!((two.value - 2.0 * truth).abs() < 0.03 * truth, "{two:?} {truth}");
        }
    }

    #[test]
    fn no_failure_gives_no_share() {
        assert_eq!(found(&[vec![1.0, 1.0]], &|_| 1.0), None);
    }

    /// A set in k dimensions about the middle, whose share is known in closed form.
    fn drawn(number: usize) -> (usize, Box<Slack>, f64) {
        let mut normals = Normals::new(1000 + number);
        let k = 1 + (20.0 * normals.uniform()) as usize;
        let rare = symdiff::math::pow(10.0, -3.0 - 4.0 * normals.uniform());
        let radius = |m: usize| {
            let (mut low, mut high) = (0.0, 20.0);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if farther_than(middle, m) > rare { low = middle } else { high = middle }
            }
            high
        };
        let first = normals.draw(k);
        let along = unit(&first);
        let m = 1 + (k as f64 * normals.uniform()) as usize;
        match number % 5 {
            // A sphere, of some or all of the parameters.
            0 => {
                let r = radius(k);
                (k, Box::new(move |z| r * r - dot(z, z)), farther_than(r, k))
            }
            1 => {
                let r = radius(m);
                (k, Box::new(move |z| r - dot(&z[..m], &z[..m]).sqrt()), farther_than(r, m))
            }
            // Two limits of one quantity, at different distances.
            2 => {
                let (a, b) = (radius(1), radius(1) + normals.uniform());
                let slack = move |z: &[f64]| (a - dot(z, &along)).min(b + dot(z, &along));
                (k, Box::new(slack), normal_cdf(-a) + normal_cdf(-b))
            }
            // Two limits of each of many.
            3 => {
                let beta = radius(1);
                let inside = 1.0 - 2.0 * normal_cdf(-beta);
                let slack = move |z: &[f64]| z[..m].iter().map(|x| beta - x.abs()).fold(f64::INFINITY, f64::min);
                (k, Box::new(slack), 1.0 - inside.powi(m as i32))
            }
            // One limit, with an even part that vanishes nowhere near.
            _ => {
                let a = radius(1);
                (k, Box::new(move |z| (a - dot(z, &along)) * (1.0 + 0.05 * dot(z, z))), normal_cdf(-a))
            }
        }
    }

    /// Number of intervals that contain the truth, and of those that are stated, among `count` draws.
    fn held(count: usize) -> (usize, usize) {
        let (mut held, mut stated) = (0, 0);
        for number in 0..count {
            let (k, slack, truth) = drawn(number);
            let share = found(&starts(k, &slack), &slack).unwrap();
            let [low, high] = share.interval;
            if low.is_nan() {
                continue;
            }
            stated += 1;
            held += usize::from(low <= truth && truth <= high);
        }
        (held, stated)
    }

    #[test]
    fn intervals_of_random_sets_contain_the_truth() {
        let (held, stated) = held(10);
        assert!(stated >= 9 && held + 1 >= stated, "{held} of {stated}");
    }

    #[test]
    #[ignore = "200 draws take a minute"]
    fn intervals_of_two_hundred_sets_contain_the_truth() {
        let (held, stated) = held(200);
        assert!(stated >= 180 && 100 * held >= 95 * stated, "{held} of {stated}");
    }
}
