//! Shares that are so small that few samples see them, by importance sampling about the likeliest points at which something fails.

use super::estimates::Estimate;
use super::mixture::{Mixture, distance, value_and_slopes};
use super::points::REPLICATES;
use crate::numerics::dot;

/// Points of a replicate.
const POINTS: usize = 1 << 12;

/// Most places about which samples are drawn.
const PLACES: usize = 6;

/// Steps to the likeliest point that fails, the longest of them, and how far out is looked.
const ROUNDS: usize = 25;
const STRIDE: f64 = 1.5;
const FARTHEST: f64 = 8.0;

/// Samples that a share takes.
pub const RARE_SAMPLES: usize = REPLICATES * POINTS;

/// The share with a negative slack, where there is a place that fails. `slack` has the values of points in independent
/// normal scores, `starts` are points from which such places are looked for.
///
/// The likeliest point that fails is found by the iteration of A. M. Hasofer & N. C. Lind and of R. Rackwitz & B. Fiessler (Computers &
/// Structures 9 (1978) 489). Samples are of a mixture of normal laws about these points and of the law itself.
pub fn rare_share(starts: &[Vec<f64>], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Estimate> {
    let mut mixture = Mixture::default();
    for start in starts {
        if let Some(place) = likeliest(start, slack) {
            mixture.add(place, PLACES);
        }
    }
    if mixture.is_plain() {
        return None;
    }
    let k = starts[0].len();
    let of_replicate = |number: usize| {
        let (points, weights) = mixture.replicate(number, k, POINTS);
        let values = slack(&points);
        // NaN fails.
        let fails = weights.iter().zip(&values).filter(|(_, value)| **value < 0.0 || value.is_nan());
        fails.map(|(weight, _)| weight).sum::<f64>() / POINTS as f64
    };
    Some(Estimate::of(&(0..REPLICATES).map(of_replicate).collect::<Vec<_>>()))
}

/// The point nearest to the middle, as far as can be seen from the start, at which nothing is left.
fn likeliest(start: &[f64], slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Vec<f64>> {
    let mut at = start.to_vec();
    let scale = slack(&[vec![0.0; at.len()]])[0].abs();
    for _ in 0..ROUNDS {
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
