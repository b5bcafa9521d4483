//! Directional sampling: along each direction from the middle, the share that fails follows from where the slack
//! changes its sign (P. Bjerager, Journal of Engineering Mechanics 114 (1988) 1285). What surrounds the middle, as a
//! sphere does, has nearly the same share along all.

use super::normals::farther_than;
use super::special::normal_quantile;
use super::tuning::TUNING;
use crate::numerics::dot;

/// Slacks that are the smaller the more of the errors is counted against them, point by point.
pub type Slacks<'s> = dyn Fn(&[Vec<f64>]) -> Vec<[f64; 3]> + 's;

/// A change of a slack's sign: number of the direction, which slack, and both ends with their values.
type Crossing = (usize, usize, [(f64, f64); 2]);

/// A direction from numbers in (0, 1).
pub fn direction(numbers: &[f64]) -> Vec<f64> {
    unit(&numbers.iter().map(|&p| normal_quantile(p)).collect::<Vec<_>>())
}

/// The direction of a point.
pub fn unit(point: &[f64]) -> Vec<f64> {
    let length = dot(point, point).sqrt().max(f64::MIN_POSITIVE);
    point.iter().map(|x| x / length).collect()
}

/// The shares that fail along directions, for each of the slacks.
pub fn shares_along(directions: &[Vec<f64>], slacks: &Slacks) -> Vec<[f64; 3]> {
    let Some(k) = directions.first().map(Vec::len) else { return Vec::new() };
    let longest = (k as f64).sqrt() + TUNING.beyond_usual;
    let radius = |step: usize| longest * step as f64 / TUNING.steps_of_ray as f64;
    let at = |direction: &[f64], r: f64| -> Vec<f64> { direction.iter().map(|x| r * x).collect() };
    let grid: Vec<Vec<f64>> = directions
        .iter()
        .flat_map(|direction| (0..=TUNING.steps_of_ray).map(move |step| (direction, step)))
        .map(|(direction, step)| at(direction, radius(step)))
        .collect();
    let values = slacks(&grid);
    let mut shares = vec![[0.0; 3]; directions.len()];
    let mut crossings: Vec<Crossing> = Vec::new();
    for (number, along) in values.chunks_exact(TUNING.steps_of_ray + 1).enumerate() {
        for which in 0..3 {
            let fails = |step: usize| along[step][which] < 0.0 || along[step][which].is_nan();
            for step in 0..TUNING.steps_of_ray {
                let ends = [step, step + 1].map(|step| (radius(step), along[step][which]));
                match (fails(step), fails(step + 1)) {
                    (true, true) => shares[number][which] += farther_than(ends[0].0, k) - farther_than(ends[1].0, k),
                    (false, false) => (),
                    _ => crossings.push((number, which, ends)),
                }
            }
            // Beyond the last step all is as it is there.
            if fails(TUNING.steps_of_ray) {
                shares[number][which] += farther_than(longest, k);
            }
        }
    }
    let mut brackets: Vec<[(f64, f64); 2]> = crossings.iter().map(|crossing| crossing.2).collect();
    for round in 0..TUNING.secants {
        let middles: Vec<f64> = brackets
            .iter()
            .map(|[(a, low), (b, high)]| {
                let secant = a - low * (b - a) / (high - low);
                let is_inside = secant > a + 1e-3 * (b - a) && secant < b - 1e-3 * (b - a);
                if is_inside && round % 3 != 2 { secant } else { 0.5 * (a + b) }
            })
            .collect();
        let points: Vec<Vec<f64>> =
            crossings.iter().zip(&middles).map(|((number, ..), r)| at(&directions[*number], *r)).collect();
        let found = slacks(&points);
        for (((_, which, _), bracket), (r, found)) in
            crossings.iter().zip(&mut brackets).zip(middles.into_iter().zip(found))
        {
            let value = found[*which];
            let side = usize::from((value >= 0.0) != (bracket[0].1 >= 0.0));
            bracket[side] = (r, value);
        }
    }
    for ((number, which, ends), [(a, low), (b, high)]) in crossings.into_iter().zip(brackets) {
        let secant = a - low * (b - a) / (high - low);
        // Written so that NaN, of unknown values, does not count.
        let root = if secant >= a && secant <= b { secant } else { 0.5 * (a + b) };
        let (from, to) = if ends[0].1 >= 0.0 { (root, ends[1].0) } else { (ends[0].0, root) };
        shares[number][which] += farther_than(from, k) - farther_than(to, k);
    }
    shares
}
