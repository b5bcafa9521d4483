//! The question whether a run is to end before its last row.

use super::tuning::TUNING;
use std::fmt;

/// Asks whether to end. The answer never goes back to no.
#[derive(Clone, Copy)]
pub struct Interruption<'a>(&'a (dyn Fn() -> bool + Sync));

impl<'a> Interruption<'a> {
    /// By this question.
    pub fn new(asked: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self(asked)
    }

    /// Whether to end.
    pub fn is_asked(self) -> bool {
        (self.0)()
    }

    /// Whether to end; asked once in a few steps, of which `step` is the number.
    pub(super) fn is_asked_in(self, step: usize) -> bool {
        step.is_multiple_of(TUNING.steps_between_questions) && self.is_asked()
    }
}

/// Never.
impl Default for Interruption<'_> {
    fn default() -> Self {
        Self(&|| false)
    }
}

impl fmt::Debug for Interruption<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Interruption")
    }
}
