//! One climb to an end of an output in a row, from gradient to gradient: quasi-Newton steps within the box.
//!
//! Parameters at an end of their intervals stay there as long as the gradient points outwards. Along the others the
//! step follows from the curvature between earlier points (limited-memory BFGS, Nocedal & Wright, Numerical
//! Optimization, algorithm 7.4). Where such a step promises too little, and as long as there is no curvature, it goes
//! to where a model that is linear in untried directions is largest (`model`): without curvature that is the corner
//! that the gradient's signs name.

use super::model::{Bend, Curvature};
use super::tuning::TUNING;
use crate::numerics::dot;

/// An output's end in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    pub row: usize,
    pub output: usize,
    /// 1 of the upper end, −1 of the lower.
    pub sign: f64,
}

impl End {
    /// Number of the end, of two: the lower one first.
    pub fn side(self) -> usize {
        usize::from(self.sign > 0.0)
    }
}

/// A point with a value and a gradient (in ξ), both upwards for the upper end, downwards for the lower.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub point: Vec<f64>,
    pub value: f64,
    pub slope: Vec<f64>,
}

/// A climb.
pub(super) struct Climb {
    pub end: End,
    start: Vec<f64>,
    /// The best point so far.
    pub best: Option<Known>,
    /// Curvatures between the best point and those before it, the latest last.
    curvatures: Vec<Curvature>,
    /// Steps from the best point that were no better.
    failures: i32,
    /// Least promised gain of a step.
    worth: f64,
    pub is_done: bool,
}

impl Climb {
    /// A climb to an end of an output whose range in the row is about `width`; its error is `allowed`.
    pub fn new(end: End, start: Vec<f64>, width: f64, allowed: f64) -> Self {
        let worth = (TUNING.worth_of_step * width).min(TUNING.worth_of_allowed * allowed);
        Self { end, start, best: None, curvatures: Vec::new(), failures: 0, worth, is_done: false }
    }

    /// Least promised gain for which a step is taken.
    pub fn worth(&self) -> f64 {
        self.worth
    }

    /// The next point; `None` if no gain is to be expected.
    pub fn step(&self) -> Option<Vec<f64>> {
        let Some(best) = &self.best else { return Some(self.start.clone()) };
        let target = self.target(best);
        // The first failure yields a curvature.
        let share = 0.5_f64.powi((self.failures - 1).max(0));
        let is_worth = gain(best, &target) > self.worth;
        is_worth.then(|| target.iter().zip(&best.point).map(|(to, x)| x + share * (to - x)).collect())
    }

    /// Gain that the best point's gradient still promises; infinite if no gradient is known.
    pub fn promise(&self) -> f64 {
        let promise = self.best.as_ref().map_or(f64::INFINITY, |best| gain(best, &self.target(best)));
        if promise.is_nan() { f64::INFINITY } else { promise }
    }

    /// Target of a whole step from the best point.
    fn target(&self, best: &Known) -> Vec<f64> {
        let Known { point, slope, .. } = best;
        let is_free = |axis: usize| slope[axis] * point[axis] < 0.0 || point[axis].abs() < 1.0;
        let free: Vec<f64> = (0..point.len()).map(|axis| if is_free(axis) { slope[axis] } else { 0.0 }).collect();
        let moved =
            |way: &[f64]| -> Vec<f64> { point.iter().zip(way).map(|(x, by)| (x + by).clamp(-1.0, 1.0)).collect() };
        let is_worth = |target: &Vec<f64>| gain(best, target) > self.worth;
        let by_curvature = self.newton(&free).map(|way| moved(&way)).filter(is_worth);
        by_curvature.unwrap_or_else(|| {
            let falling = self.curvatures.iter().filter(|own| is_falling(&own.moved, &own.fall));
            Bend::of(falling).largest(point, slope)
        })
    }

    /// The step to the point where the gradient vanishes, as predicted by the curvatures, along the axes along which it
    /// does not vanish already; `None` without any curvature.
    fn newton(&self, slope: &[f64]) -> Option<Vec<f64>> {
        let along = |vector: &[f64]| -> Vec<f64> {
            vector.iter().zip(slope).map(|(own, slope)| if *slope == 0.0 { 0.0 } else { *own }).collect()
        };
        let pairs: Vec<(Vec<f64>, Vec<f64>)> = self
            .curvatures
            .iter()
            .map(|own| (along(&own.moved), along(&own.fall)))
            .filter(|(moved, fall)| is_falling(moved, fall))
            .collect();
        let (moved, fall) = pairs.last()?;
        let scale = dot(moved, fall) / dot(fall, fall);
        let mut way = slope.to_vec();
        let mut shares = Vec::with_capacity(pairs.len());
        for (moved, fall) in pairs.iter().rev() {
            let share = dot(moved, &way) / dot(moved, fall);
            way.iter_mut().zip(fall).for_each(|(way, fall)| *way -= share * fall);
            shares.push(share);
        }
        way.iter_mut().for_each(|way| *way *= scale);
        for ((moved, fall), share) in pairs.iter().zip(shares.into_iter().rev()) {
            let by = share - dot(fall, &way) / dot(moved, fall);
            way.iter_mut().zip(moved).for_each(|(way, moved)| *way += by * moved);
        }
        Some(way)
    }

    /// Takes in a point.
    pub fn take(&mut self, found: Known) {
        let is_known = found.value.is_finite() && found.slope.iter().all(|slope| slope.is_finite());
        let Some(best) = &mut self.best else {
            // If nothing is known of its start a climb does not begin.
            (self.is_done, self.best) = if is_known { (false, Some(found)) } else { (true, None) };
            return;
        };
        self.failures += 1;
        if !is_known {
            return;
        }
        let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        let between = Curvature { moved: less(&found.point, &best.point), fall: less(&best.slope, &found.slope) };
        self.curvatures.push(between);
        if self.curvatures.len() > TUNING.memory_of_curvature {
            self.curvatures.remove(0);
        }
        if found.value > best.value {
            *best = found;
            self.failures = 0;
        }
    }
}

/// Whether the gradient falls along a move.
fn is_falling(moved: &[f64], fall: &[f64]) -> bool {
    dot(moved, fall) > TUNING.no_curvature * (dot(moved, moved) * dot(fall, fall)).sqrt()
}

/// Gain that a gradient promises on the way to a target.
fn gain(best: &Known, target: &[f64]) -> f64 {
    target.iter().zip(&best.point).zip(&best.slope).map(|((to, x), slope)| slope * (to - x)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Climbs to the greatest value of a function with this gradient; the number of steps, and the climb.
    fn climbed(start: &[f64], value: impl Fn(&[f64]) -> f64, slope: impl Fn(&[f64]) -> Vec<f64>) -> (usize, Climb) {
        let mut climb = Climb::new(End { row: 0, output: 0, sign: 1.0 }, start.to_vec(), 1.0, 1.0);
        assert_eq!(climb.promise(), f64::INFINITY);
        for steps in 0..40 {
            let Some(step) = climb.step() else { return (steps, climb) };
            climb.take(Known { value: value(&step), slope: slope(&step), point: step });
        }
        (40, climb)
    }

    /// −(x − a)² + b y: an extreme within, and one at the end.
    #[test]
    fn steps_find_inner_extremes_and_those_at_ends() {
        let value = |x: &[f64]| -(x[0] - 0.3).powi(2) + 2.0 * x[1];
        let (steps, climb) = climbed(&[0.0, 0.0], value, |x| vec![-2.0 * (x[0] - 0.3), 2.0]);
        let best = climb.best.as_ref().unwrap();
        assert!(steps < 8 && climb.promise() < 1e-3, "{steps}");
        assert!((best.point[0] - 0.3).abs() < 0.02 && best.point[1] == 1.0, "{best:?}");
    }

    /// A ridge across all axes, along which the function rises slowly: −20 (Σ x)² + Σ bᵢ xᵢ. With Σ x = 0 the greatest
    /// of Σ bᵢ xᵢ has its largest half at 1, the others at −1.
    #[test]
    fn a_ridge_is_followed_to_its_end() {
        let b = [0.1, 0.25, 0.3, 0.4, 0.55, 0.6];
        let value = |x: &[f64]| -20.0 * x.iter().sum::<f64>().powi(2) + dot(&b, x);
        let slope = |x: &[f64]| b.iter().map(|own| own - 40.0 * x.iter().sum::<f64>()).collect();
        let (steps, climb) = climbed(&[0.0; 6], value, slope);
        let best = climb.best.as_ref().unwrap();
        // Beside the ridge by 0.35/40 of the sum.
        let most = 0.9 + 0.35 * 0.35 / 80.0;
        assert!(best.value > most - 5e-3, "{} of {most} after {steps} steps: {best:?}", best.value);
    }

    /// The same along a bent ridge: b · x − 20 g(x)². Where g vanishes, b · x is largest in the corner x₀ = x₁ = 1;
    /// x₂ = −0.6 follows.
    #[test]
    fn a_bent_ridge_is_followed_to_its_end() {
        let g = |x: &[f64]| 0.3 * x[0] + 0.2 * x[1] + x[2] + 0.2 * x[0] * x[0] - 0.1;
        let value = |x: &[f64]| 0.02 * x[0] + 0.01 * x[1] - 20.0 * g(x).powi(2);
        let slope = |x: &[f64]| {
            let by = -40.0 * g(x);
            vec![0.02 + by * (0.3 + 0.4 * x[0]), 0.01 + 0.2 * by, by]
        };
        let (steps, climb) = climbed(&[-0.7, -0.7, 0.3], value, slope);
        let best = climb.best.as_ref().unwrap();
        assert!(best.value > 0.03 - 1e-3, "{} of 0.03 after {steps} steps: {best:?}", best.value);
    }
}
