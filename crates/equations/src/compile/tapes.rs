//! Common traits of all programs of a system: tapes over one memory; their first stage depends on parameters only.

use symdiff::{Lowered, Tape};

/// A program of a system.
pub trait Tapes {
    /// Its tapes and their memory.
    fn lowered(&self) -> &Lowered;

    /// Number of registers of its memory.
    fn registers(&self) -> usize {
        self.lowered().registers
    }

    /// Numbers that a new memory holds.
    fn constants(&self) -> &[(u32, f64)] {
        &self.lowered().constants
    }

    /// Once a sample, or for a box of parameters: the values that depend on parameters only.
    fn sample(&self) -> &Tape {
        &self.lowered().stages[0]
    }
}
