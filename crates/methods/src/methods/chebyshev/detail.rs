//! How closely an adaptive surrogate is examined.

use super::sub_box::SubBox;

/// Estimates in addition to ranges and the surrogate's errors.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// Nothing.
    Errors,
    /// The time steps' errors.
    StepErrors,
    /// These, and the parameters' sensitivities.
    Sensitivities,
}

impl Detail {
    /// Estimates at the end: sensitivities only where the box was not split.
    pub fn of(boxes: &[SubBox]) -> Self {
        if boxes.len() == 1 { Self::Sensitivities } else { Self::StepErrors }
    }
}
