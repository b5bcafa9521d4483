//! The order of designs: requirements first, then the objective.

use std::cmp::Ordering;

use super::axes::Axes;
use super::tuning::TUNING;
use crate::model::{Design, Objective};
use crate::numerics::Linear;

/// Objective, in the slacks of all requirements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The least of all is to be large.
    Margin,
    /// The last is to be large, the others are not to be negative.
    Last,
    /// The cost is to be small, and each requirement is to leave this margin.
    Cost(f64),
}

/// Merit of a design.
#[derive(Clone, Copy, Debug)]
pub struct Merit {
    /// Largest violation of the requirements that have to hold, as a share of a limit.
    pub violation: f64,
    /// The objective, which is to be large.
    pub value: f64,
}

impl Goal {
    pub fn of(design: &Design) -> Self {
        match design.objective {
            Objective::Margin => Self::Margin,
            Objective::Worst { .. } => Self::Last,
            Objective::Cost => Self::Cost(0.0),
        }
    }

    /// The margin that requirements are to leave.
    pub fn margin(self) -> f64 {
        if let Self::Cost(margin) = self { margin } else { 0.0 }
    }

    /// Slacks of a point that count: for a cost, they are reduced by the margin, and the negative cost is appended.
    pub fn counted(self, axes: &Axes, point: &[f64], mut slacks: Vec<f64>) -> Vec<f64> {
        if let Self::Cost(margin) = self {
            slacks.iter_mut().for_each(|slack| *slack -= margin);
            slacks.push(-axes.cost(point));
        }
        slacks
    }

    /// The merit of a design of which this counts.
    pub fn merit(self, slacks: &[f64]) -> Merit {
        let least = |own: &[f64]| own.iter().copied().fold(f64::INFINITY, f64::min);
        match (self, slacks) {
            (Self::Last | Self::Cost(_), [limits @ .., last]) => {
                let violation = (-least(limits)).max(0.0);
                Merit { violation: if violation < TUNING.equal_violations { 0.0 } else { violation }, value: *last }
            }
            _ => Merit { violation: 0.0, value: least(slacks) },
        }
    }

    /// Goals and limits among linearised slacks, each with its number among `count`.
    pub fn split(self, count: usize, all: Vec<(usize, Linear)>) -> [Vec<Linear>; 2] {
        let is_goal = |own: usize| self == Self::Margin || own + 1 == count;
        let (goals, limits): (Vec<_>, Vec<_>) = all.into_iter().partition(|(requirement, _)| is_goal(*requirement));
        [goals, limits].map(|own| own.into_iter().map(|(_, linear)| linear).collect())
    }
}

impl Merit {
    /// Whether it is better than another one.
    pub fn is_better(&self, other: &Self) -> bool {
        match (self.violation - other.violation).abs() > TUNING.equal_violations {
            true => self.violation < other.violation,
            false => self.value > other.value,
        }
    }

    /// Whether it is better than another one where a violation counts so much; for an infinite weight it comes first.
    pub fn is_better_by(&self, other: &Self, weight: f64) -> bool {
        if weight.is_infinite() {
            return self.is_better(other);
        }
        self.value - weight * self.violation > other.value - weight * other.violation
    }

    /// The better one first.
    pub fn order(&self, other: &Self) -> Ordering {
        self.violation.total_cmp(&other.violation).then(other.value.total_cmp(&self.value))
    }
}
