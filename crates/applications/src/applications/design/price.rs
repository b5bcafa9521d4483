//! Tolerances that are chosen with the nominal values, by their cost.

use super::axes::Axes;
use super::goal::Goal;
use super::tuning::TUNING;
use super::width::Width;
use super::worst::Assessed;
use crate::numerics::{Linear, best_step};

/// Assessment with the cost as the objective: slacks of the requirements beyond a margin, then the negative cost.
pub struct Priced<'s> {
    pub requirements: Box<dyn Assessed + 's>,
    pub axes: &'s Axes,
    pub goal: Goal,
}

impl Assessed for Priced<'_> {
    fn slacks(&mut self, point: &[f64]) -> Vec<f64> {
        let slacks = self.requirements.slacks(point);
        self.goal.counted(self.axes, point, slacks)
    }

    fn has_learnt(&self) -> bool {
        self.requirements.has_learnt()
    }

    fn linearised(&mut self, point: &[f64]) -> Vec<(usize, Linear)> {
        let mut all = self.requirements.linearised(point);
        let margin = self.goal.margin();
        all.iter_mut().for_each(|(_, linear)| linear.value -= margin);
        let multiples = &point[self.axes.free.len()..];
        let mut cost = Linear { value: 0.0, slopes: vec![0.0; self.axes.free.len()] };
        for (width, multiple) in self.axes.widths.iter().zip(multiples) {
            let [value, slope] = width.tangent(*multiple);
            cost.value -= value;
            cost.slopes.push(-slope);
        }
        all.push((self.requirements.count(), cost));
        all
    }

    fn count(&self) -> usize {
        self.requirements.count() + 1
    }

    /// The cost is a convex function of the multiples: each has an unknown of its own above its tangents, which are
    /// added where the step ends (J. E. Kelley, J. SIAM 8 (1960) 703).
    fn step(&self, point: &[f64], goals: &[Linear], limits: &[Linear], [least, most]: [&[f64]; 2]) -> Vec<f64> {
        let (first, k) = (self.axes.free.len(), point.len());
        let widths = &self.axes.widths;
        let count = widths.len();
        if count == 0 {
            return best_step(goals, limits, least, most);
        }
        let mut limits = limits.to_vec();
        limits.iter_mut().for_each(|limit| limit.slopes.resize(k + count, 0.0));
        let above_tangent = |index: usize, at: f64| {
            let [value, slope] = widths[index].tangent(at);
            let mut slopes = vec![0.0; k + count];
            (slopes[first + index], slopes[k + index]) = (-slope, 1.0);
            Linear { value: -(value + slope * (point[first + index] - at)), slopes }
        };
        let cost = |index: usize, step: f64| widths[index].cost(point[first + index] + step);
        let (mut lowest, mut highest) = (least.to_vec(), most.to_vec());
        for index in 0..count {
            let ends = [least[first + index], 0.0, most[first + index]];
            limits.extend(ends.map(|step| above_tangent(index, point[first + index] + step)));
            lowest.push(cost(index, most[first + index]));
            highest.push(cost(index, least[first + index]));
        }
        let slopes = (0..k + count).map(|unknown| if unknown < k { 0.0 } else { -1.0 }).collect();
        let goal = [Linear { value: 0.0, slopes }];
        let mut step = Vec::new();
        for _ in 0..TUNING.rounds_of_tangents {
            step = best_step(&goal, &limits, &lowest, &highest);
            let is_below = |index: &usize| {
                let own = cost(*index, step[first + index]);
                step[k + index] < own - TUNING.left_by_tangents * own.abs()
            };
            let below: Vec<usize> = (0..count).filter(is_below).collect();
            if below.is_empty() {
                break;
            }
            limits.extend(
                below.into_iter().map(|index| above_tangent(index, point[first + index] + step[first + index])),
            );
        }
        step.truncate(k);
        step
    }

    /// A point with all tolerances tighter by one factor.
    fn restored(&mut self, point: Vec<f64>) -> Vec<f64> {
        let first = self.axes.free.len();
        let with = |factor: f64| -> Vec<f64> {
            let width = |(width, multiple): (&Width, &f64)| (factor * multiple).clamp(width.ends[0], width.ends[1]);
            let widths = self.axes.widths.iter().zip(&point[first..]).map(width);
            point[..first].iter().copied().chain(widths).collect()
        };
        let margin = self.goal.margin();
        let mut left =
            |point: &[f64]| self.requirements.slacks(point).into_iter().fold(f64::INFINITY, f64::min) - margin;
        let without = left(&with(0.0));
        let mut factor = 1.0;
        for _ in 0..TUNING.tightened {
            let own = left(&with(factor));
            // Nominal values that miss the margin are no matter of tolerances.
            if own >= 0.0 || without.is_nan() || without <= 0.0 {
                break;
            }
            factor *= without / (without - own);
        }
        with(factor)
    }
}
