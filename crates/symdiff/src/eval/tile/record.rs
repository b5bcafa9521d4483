//! Values that runs of tapes replace, so that the tapes can be followed backwards.

use crate::lower::tape::Tape;

/// Stores values before they are replaced.
pub(super) trait Keep {
    /// Called before instructions of one operation run: their part of the tape.
    fn run(&mut self, index: usize);

    /// Called before a register of `W` lanes is replaced.
    ///
    /// # Safety
    /// The memory has the register, and there is room for it: see [`Record::begin`].
    unsafe fn register<const W: usize>(&mut self, memory: *const f64, register: u32);
}

/// Stores nothing.
pub(super) struct Nothing;

impl Keep for Nothing {
    #[inline(always)]
    fn run(&mut self, _: usize) {}

    #[inline(always)]
    unsafe fn register<const W: usize>(&mut self, _: *const f64, _: u32) {}
}

/// Replaced values and parts of the tapes, in the order of the runs: the last run is undone first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// Values of all lanes of a register, one register after the other.
    replaced: Vec<f64>,
    /// Parts of the tapes that ran.
    parts: Vec<usize>,
    /// Start of each run in both.
    runs: Vec<(usize, usize)>,
}

impl Record {
    /// Begins a run of a tape in a memory of `width` lanes.
    pub fn begin(&mut self, tape: &Tape, width: usize) {
        self.runs.push((self.replaced.len(), self.parts.len()));
        self.replaced.reserve(tape.written() * width);
    }

    /// Values that the last run replaced, and the parts that it ran.
    pub fn last(&self) -> (&[f64], &[usize]) {
        let (replaced, parts) = self.runs.last().copied().unwrap_or_default();
        (&self.replaced[replaced..], &self.parts[parts..])
    }

    /// Removes the last run, but not its memory.
    pub fn end(&mut self) {
        if let Some((replaced, parts)) = self.runs.pop() {
            self.replaced.truncate(replaced);
            self.parts.truncate(parts);
        }
    }
}

impl Keep for Record {
    #[inline(always)]
    fn run(&mut self, index: usize) {
        self.parts.push(index);
    }

    #[inline(always)]
    unsafe fn register<const W: usize>(&mut self, memory: *const f64, register: u32) {
        let length = self.replaced.len();
        debug_assert!(length + W <= self.replaced.capacity(), "room was made for what the tape writes");
        // SAFETY: the memory has the register, of `W` values, and `begin` made room for all that the tape writes.
        unsafe {
            let values = memory.add(register as usize * W).cast::<[f64; W]>();
            self.replaced.as_mut_ptr().add(length).cast::<[f64; W]>().copy_from_nonoverlapping(values, 1);
            self.replaced.set_len(length + W);
        }
    }
}
