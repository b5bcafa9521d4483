//! Tolerances that are chosen with the nominal values, by their cost.

use super::axes::Axes;
use super::goal::Goal;
use super::worst::Assessed;
use crate::numerics::{Linear, best_step};
use crate::study::allocate::{Choice, Item};

/// Rounds in which a step's costs get their tangents, and what a tangent may leave, as a share of the cost.
const ROUNDS: usize = 12;
const CLOSE: f64 = 1e-7;

/// Most times that tolerances are tightened until a point leaves its margin.
const TIGHTENED: usize = 6;

/// A tolerance that is chosen.
#[derive(Clone, Debug)]
pub struct Width {
    /// Least and largest multiple of the model's tolerance.
    pub ends: [f64; 2],
    item: Item,
    curve: Curve,
}

/// Its cost, a convex function of the multiple.
#[derive(Clone, Debug)]
enum Curve {
    /// So much at the model's tolerance, and inversely as much at a multiple.
    Reciprocal(f64),
    /// Straight lines between these multiples and costs: the lower hull of grades, the tightest first.
    Hull(Vec<[f64; 2]>),
}

impl Width {
    /// Of a tolerance whose cost depends on it.
    pub fn of(item: &Item) -> Option<Self> {
        let curve = match &item.choice {
            Choice::Fixed | Choice::Together => return None,
            Choice::Reciprocal(cost) => Curve::Reciprocal(*cost),
            Choice::Grades(grades) => Curve::Hull(lower_hull(grades.iter().rev().map(|own| [own.0, own.1]))),
        };
        Some(Self { ends: [item.tightest(), item.widest], item: item.clone(), curve })
    }

    /// The cost of a multiple, between grades, too.
    pub fn cost(&self, multiple: f64) -> f64 {
        self.tangent(multiple)[0]
    }

    /// The same as the model has it; NaN below the tightest grade.
    pub fn price(&self, multiple: f64) -> f64 {
        self.item.cost(multiple).unwrap_or(f64::NAN)
    }

    /// Cost and its derivative.
    fn tangent(&self, multiple: f64) -> [f64; 2] {
        match &self.curve {
            Curve::Reciprocal(cost) => [cost / multiple, -cost / (multiple * multiple)],
            Curve::Hull(hull) => match hull.windows(2).rfind(|pair| pair[0][0] <= multiple) {
                Some(pair) => {
                    let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
                    [pair[0][1] + slope * (multiple - pair[0][0]), slope]
                }
                None => [hull[0][1], 0.0],
            },
        }
    }
}

/// The lower hull of points that ascend in the first coordinate (A. M. Andrew, Inf. Process. Lett. 9 (1979) 216).
fn lower_hull(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., a, b] = hull.as_slice()
            && (b[0] - a[0]) * (point[1] - a[1]) <= (b[1] - a[1]) * (point[0] - a[0])
        {
            hull.pop();
        }
        hull.push(point);
    }
    hull
}

/// What counts where the cost is the objective: what requirements leave beyond a margin, then the cost with the other
/// sign.
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
        for _ in 0..ROUNDS {
            step = best_step(&goal, &limits, &lowest, &highest);
            let is_below = |index: &usize| {
                let own = cost(*index, step[first + index]);
                step[k + index] < own - CLOSE * own.abs()
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

    /// With tolerances that are all tighter by one factor.
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
        for _ in 0..TIGHTENED {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_leave_out_grades_above_the_line_of_others() {
        let grades = [[1.0, 8.0], [2.0, 7.0], [3.0, 2.0], [4.0, 1.5], [5.0, 1.0]];
        assert_eq!(lower_hull(grades.into_iter()), [[1.0, 8.0], [3.0, 2.0], [5.0, 1.0]]);
    }
}
