//! The question whether a run is to end before its last row.

use super::tuning::TUNING;
use std::fmt;

/// Asks whether to end. The answer never goes back to no.
#[derive(Clone, Copy)]
pub struct Interruption<'a>(&'a (dyn Fn() -> bool + Sync));

impl<'a> Interruption<'a> {
    /// An interruption by the question `asked`.
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

/// The question in a run of many steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepInterruption<'a> {
    interruption: Interruption<'a>,
    /// Steps since the run went on.
    steps: usize,
    is_cut: bool,
}

impl<'a> From<Interruption<'a>> for StepInterruption<'a> {
    fn from(interruption: Interruption<'a>) -> Self {
        Self { interruption, ..Self::default() }
    }
}

impl<'a> StepInterruption<'a> {
    /// The run goes on.
    pub fn begin(&mut self) {
        self.steps = 0;
    }

    /// Whether to end before a step.
    pub fn ends(&mut self) -> bool {
        self.is_cut |= self.interruption.is_asked_in(self.steps);
        self.steps += 1;
        self.is_cut
    }

    /// Whether to end, asked at once: before a step that takes long, or a row.
    pub fn ends_now(&mut self) -> bool {
        self.is_cut |= self.interruption.is_asked();
        self.is_cut
    }

    /// Whether it ended.
    pub fn is_cut(&self) -> bool {
        self.is_cut
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
