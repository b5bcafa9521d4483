//! Subset simulation: reaches rare failures level by level. It sees failing sets of any shape, in many dimensions.

use super::normals::Normals;
use super::points::REPLICATES;
use super::tuning::TUNING;

/// Result of subset simulation.
#[derive(Clone, Debug)]
pub struct Subset {
    /// The share that fails, by replicate.
    pub shares: Vec<f64>,
    /// Points that fail, as they are distributed among all that do.
    pub failing: Vec<Vec<f64>>,
}

/// The share of the normal law in k dimensions with a negative slack (S.-K. Au & J. L. Beck, Probabilistic Engineering
/// Mechanics 16 (2001) 263), by chains of I. Papaioannou et al., Probabilistic Engineering Mechanics 41 (2015) 89.
/// `None` if nothing is found to fail.
pub fn subset(k: usize, slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> Option<Subset> {
    let mut found = Subset { shares: Vec::with_capacity(REPLICATES), failing: Vec::new() };
    for number in 0..REPLICATES {
        let (share, failing) = replicate(number, k, slack);
        found.shares.push(share);
        found.failing.extend(failing);
    }
    (!found.failing.is_empty()).then_some(found)
}

fn replicate(number: usize, k: usize, slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>) -> (f64, Vec<Vec<f64>>) {
    let mut normals = Normals::new(number);
    let mut points: Vec<Vec<f64>> = (0..TUNING.samples_of_level).map(|_| normals.draw(k)).collect();
    let mut values = known(slack(&points));
    let (mut share, mut level) = (1.0, f64::INFINITY);
    for _ in 0..TUNING.levels {
        let mut order: Vec<usize> = (0..TUNING.samples_of_level).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]).then(a.cmp(&b)));
        let next = values[order[TUNING.seeds_of_level - 1]];
        if next < 0.0 {
            let failing: Vec<usize> = order.into_iter().take_while(|&index| values[index] < 0.0).collect();
            share *= failing.len() as f64 / TUNING.samples_of_level as f64;
            return (share, failing.into_iter().map(|index| std::mem::take(&mut points[index])).collect());
        }
        if next >= level {
            break;
        }
        level = next;
        share *= TUNING.seeds_of_level as f64 / TUNING.samples_of_level as f64;
        let seeds = order[..TUNING.seeds_of_level]
            .iter()
            .map(|&index| (std::mem::take(&mut points[index]), values[index]))
            .collect();
        (points, values) = chains(seeds, level, &mut normals, slack);
    }
    (0.0, Vec::new())
}

/// Chains from each seed below a level, until there are as many samples as before.
fn chains(
    seeds: Vec<(Vec<f64>, f64)>,
    level: f64,
    normals: &mut Normals,
    slack: &dyn Fn(&[Vec<f64>]) -> Vec<f64>,
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (mut at, mut of): (Vec<Vec<f64>>, Vec<f64>) = seeds.into_iter().unzip();
    let (mut points, mut values) = (at.clone(), of.clone());
    let mut share = TUNING.first_share;
    for step in 1..TUNING.samples_of_level / TUNING.seeds_of_level {
        let kept = (1.0 - share * share).sqrt();
        let moved = |point: &Vec<f64>| -> Vec<f64> {
            point.iter().zip(normals.draw(point.len())).map(|(old, new)| kept * old + share * new).collect()
        };
        let tried: Vec<Vec<f64>> = at.iter().map(moved).collect();
        let found = known(slack(&tried));
        let mut accepted = 0;
        for (index, (point, value)) in tried.into_iter().zip(found).enumerate() {
            if value <= level {
                (at[index], of[index]) = (point, value);
                accepted += 1;
            }
        }
        let apart = accepted as f64 / TUNING.seeds_of_level as f64 - TUNING.accepted;
        share = (share * symdiff::math::exp(apart / (step as f64).sqrt())).clamp(0.05, 1.0);
        points.extend_from_slice(&at);
        values.extend_from_slice(&of);
    }
    (points, values)
}

/// The values with −∞ in place of NaN, so that unknown values fail.
fn known(values: Vec<f64>) -> Vec<f64> {
    values.into_iter().map(|value| if value.is_nan() { f64::NEG_INFINITY } else { value }).collect()
}
