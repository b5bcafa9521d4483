//! Shares that are so small that few samples see them, by importance sampling about the likeliest points at which something fails.

use super::estimates::Estimate;
use super::points::{REPLICATES, replicate};
use super::special::normal_quantile;
use crate::numerics::dot;
use symdiff::math;

/// Share of the samples that is drawn from the law itself: no weight is more than its reciprocal.
const DEFENSIVE: f64 = 0.2;

/// Points of a replicate.
const POINTS: usize = 1 << 12;

/// Most places about which samples are drawn.
const PLACES: usize = 6;

/// Steps to the likeliest point that fails, the longest of them, a difference quotient's, and how far out is looked.
const ROUNDS: usize = 25;
const STRIDE: f64 = 1.5;
const STEP: f64 = 1e-2;
const FARTHEST: f64 = 8.0;

/// Places nearer to each other than this are one.
const APART: f64 = 0.7;

/// Samples that a share takes.
pub const RARE_SAMPLES: usize = REPLICATES * POINTS;

/// The share with a negative slack, where there is a place that fails. `slack` has the values of points in independent
/// normal scores, `starts` are points from which such places are looked for.
///
/// The likeliest point that fails is found by the iteration of A. M. Hasofer & N. C. Lind and of R. Rackwitz & B. Fiessler (Computers &
/// Structures 9 (1978) 489). Samples are of a mixture of normal laws about these points and of the law itself, each weighted by the ratio of the
/// densities (T. Hesterberg, Technometrics 37 (1995) 185).
pub fn rare_share(starts: &[Vec<f64>], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Estimate> {
    let mut places: Vec<Vec<f64>> = Vec::new();
    for start in starts {
        let Some(place) = likeliest(start, slack) else { continue };
        let is_new = |known: &Vec<f64>| distance(known, &place) > APART;
        if places.len() < PLACES && places.iter().all(is_new) {
            places.push(place);
        }
    }
    let k = places.first()?.len();
    let of_replicate = |number: usize| {
        let points: Vec<Vec<f64>> =
            replicate(number, k + 1, POINTS).chunks_exact(k + 1).map(|point| drawn(point, &places)).collect();
        let values = slack(&points);
        // NaN fails.
        let fails = points.iter().zip(&values).filter(|(_, value)| **value < 0.0 || value.is_nan());
        fails.map(|(point, _)| weight(point, &places)).sum::<f64>() / POINTS as f64
    };
    Some(Estimate::of(&(0..REPLICATES).map(of_replicate).collect::<Vec<_>>()))
}

/// A point of the mixture from evenly spread numbers: the first says about which place.
fn drawn(numbers: &[f64], places: &[Vec<f64>]) -> Vec<f64> {
    let about = (numbers[0] - DEFENSIVE) / (1.0 - DEFENSIVE) * places.len() as f64;
    let place = (about >= 0.0).then(|| &places[(about as usize).min(places.len() - 1)]);
    let score = |(axis, &p): (usize, &f64)| normal_quantile(p) + place.map_or(0.0, |place| place[axis]);
    numbers[1..].iter().enumerate().map(score).collect()
}

/// The law's density over the mixture's.
fn weight(point: &[f64], places: &[Vec<f64>]) -> f64 {
    let each = (1.0 - DEFENSIVE) / places.len() as f64;
    let ratio = |place: &Vec<f64>| each * math::exp(dot(point, place) - 0.5 * dot(place, place));
    1.0 / (DEFENSIVE + places.iter().map(ratio).sum::<f64>())
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The point nearest to the middle, as far as can be seen from the start, at which nothing is left.
fn likeliest(start: &[f64], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Vec<f64>> {
    let mut at = start.to_vec();
    let scale = slack(&[vec![0.0; at.len()]])[0].abs();
    for _ in 0..ROUNDS {
        let mut points = vec![at.clone()];
        for axis in 0..at.len() {
            for step in [STEP, -STEP] {
                let mut point = at.clone();
                point[axis] += step;
                points.push(point);
            }
        }
        let values = slack(&points);
        let slopes: Vec<f64> =
            (0..at.len()).map(|axis| (values[2 * axis + 1] - values[2 * axis + 2]) / (2.0 * STEP)).collect();
        let squared = dot(&slopes, &slopes);
        if squared == 0.0 || !squared.is_finite() {
            return None;
        }
        let along = (dot(&slopes, &at) - values[0]) / squared;
        let wanted: Vec<f64> = slopes.iter().map(|slope| along * slope).collect();
        let length = distance(&wanted, &at);
        if length < 1e-3 && values[0].abs() < 1e-3 * scale {
            break;
        }
        let share = (STRIDE / length).min(1.0);
        at.iter_mut().zip(&wanted).for_each(|(at, wanted)| *at += share * (wanted - *at));
    }
    let found = slack(std::slice::from_ref(&at))[0];
    (dot(&at, &at) < FARTHEST * FARTHEST && found <= 0.1 * scale).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::super::special::normal_cdf;
    use super::*;

    #[test]
    fn tails_that_no_sample_would_see() {
        for beta in [4.0, 5.5, 7.0] {
            // Φ(−β) along one direction, and twice that where both sides fail.
            let direction = [0.6, 0.0, 0.8];
            let one = |points: &[Vec<f64>]| points.iter().map(|z| beta - dot(z, &direction)).collect::<Vec<f64>>();
            let found = rare_share(&[vec![1.0, 0.1, 1.0]], &one).unwrap();
            let truth = normal_cdf(-beta);
            assert!((found.value - truth).abs() < 2.0 * found.sampling && found.sampling < 0.02 * truth, "{found:?}");
            let two =
                |points: &[Vec<f64>]| points.iter().map(|z| beta - dot(z, &direction).abs()).collect::<Vec<f64>>();
            let found = rare_share(&[vec![1.0, 0.1, 1.0], vec![-1.0, 0.0, -1.0]], &two).unwrap();
            assert!((found.value - 2.0 * truth).abs() < 0.02 * truth, "{found:?}");
        }
    }

    #[test]
    fn a_curved_limit() {
        // |z|² > r² in two dimensions: exp(−r²/2), about a ring on which every point is likeliest.
        let slack = |points: &[Vec<f64>]| points.iter().map(|z| 5.0 - dot(z, z).sqrt()).collect::<Vec<f64>>();
        let starts: Vec<Vec<f64>> = [[3.0, 0.0], [-3.0, 0.1], [0.0, 3.0], [0.1, -3.0]].map(Vec::from).to_vec();
        let found = rare_share(&starts, &slack).unwrap();
        let truth = (-12.5_f64).exp();
        assert!(
            (found.value - truth).abs() < 3.0 * found.sampling && found.sampling < 0.2 * truth,
            "{found:?} {truth}"
        );
    }

    #[test]
    fn where_nothing_fails_there_is_no_share() {
        let slack = |points: &[Vec<f64>]| vec![1.0; points.len()];
        assert_eq!(rare_share(&[vec![1.0, 1.0]], &slack), None);
    }
}
