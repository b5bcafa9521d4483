//! The order of designs: requirements first, then the objective.

use std::cmp::Ordering;

use crate::model::{Design, Objective};
use crate::numerics::Linear;

/// Violations that differ by less are equal, and one of less is none: shares of limits.
const ROUNDING: f64 = 1e-9;

/// Objective, in the slacks of all requirements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// The least of all is to be large.
    Margin,
    /// The last is to be large, the others are not to be negative.
    Last,
}

/// How good a design is.
#[derive(Clone, Copy, Debug)]
pub struct Merit {
    /// By how much the requirements are missed that have to hold, as a share of a limit.
    pub violation: f64,
    /// The objective, which is to be large.
    pub value: f64,
}

impl Goal {
    pub fn of(design: &Design) -> Self {
        match design.objective {
            Objective::Margin => Self::Margin,
            Objective::Worst { .. } => Self::Last,
        }
    }

    /// The merit of a design with these least slacks, of each requirement.
    pub fn merit(self, slacks: &[f64]) -> Merit {
        let least = |own: &[f64]| own.iter().copied().fold(f64::INFINITY, f64::min);
        match (self, slacks) {
            (Self::Last, [limits @ .., last]) => {
                let violation = (-least(limits)).max(0.0);
                Merit { violation: if violation < ROUNDING { 0.0 } else { violation }, value: *last }
            }
            _ => Merit { violation: 0.0, value: least(slacks) },
        }
    }

    /// Goals and limits among linearised slacks, each with its requirement's number.
    pub fn split(self, count: usize, all: Vec<(usize, Linear)>) -> [Vec<Linear>; 2] {
        let is_goal = |requirement: usize| self == Self::Margin || requirement + 1 == count;
        let (goals, limits): (Vec<_>, Vec<_>) = all.into_iter().partition(|(requirement, _)| is_goal(*requirement));
        [goals, limits].map(|own| own.into_iter().map(|(_, linear)| linear).collect())
    }
}

impl Merit {
    /// Whether it is better than another one.
    pub fn is_better(&self, other: &Self) -> bool {
        match (self.violation - other.violation).abs() > ROUNDING {
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
