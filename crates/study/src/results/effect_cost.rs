//! Instructions that an effect adds to a step: data for `mbint explain` and the documentation.

use serde::Serialize;

/// Instructions of the parts of a step, or differences of them: without an effect elimination may take another order,
/// and a part then even becomes longer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StepInstructions {
    /// Once a step: prediction and values known at its beginning.
    pub step: i64,
    /// When the Newton matrix is factored.
    pub factor: i64,
    /// Every Newton iteration.
    pub iteration: i64,
}

impl StepInstructions {
    /// Difference to `less`.
    #[must_use]
    pub fn beyond(self, less: Self) -> Self {
        Self {
            step: self.step - less.step,
            factor: self.factor - less.factor,
            iteration: self.iteration - less.iteration,
        }
    }
}

impl std::ops::Add for StepInstructions {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            step: self.step + other.step,
            factor: self.factor + other.factor,
            iteration: self.iteration + other.iteration,
        }
    }
}

/// Instructions that one effect adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct EffectCost {
    /// Cost while it acts.
    pub active: StepInstructions,
    /// Cost while it and its like touch nothing in any sample of a tile; absent if it always acts.
    pub inactive: Option<StepInstructions>,
}
