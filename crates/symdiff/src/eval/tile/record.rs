//! What a run of a tape replaces, so that the tape can be followed backwards.

/// Keeps values before they are replaced.
pub(super) trait Keep {
    /// Instructions of one operation are run: their part of the tape.
    fn run(&mut self, place: usize);

    /// A register of `W` lanes is about to be replaced.
    ///
    /// # Safety
    /// The memory has the register.
    unsafe fn register<const W: usize>(&mut self, memory: *const f64, register: u32);
}

/// Keeps nothing.
pub(super) struct Nothing;

impl Keep for Nothing {
    #[inline(always)]
    fn run(&mut self, _: usize) {}

    #[inline(always)]
    unsafe fn register<const W: usize>(&mut self, _: *const f64, _: u32) {}
}

/// Replaced values and the parts of the tape that were run, in the order of the run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// Values of all lanes of a register, one register after the other.
    pub replaced: Vec<f64>,
    /// Parts of the tape.
    pub parts: Vec<usize>,
}

impl Record {
    /// Forgets the last run, and keeps its room.
    pub fn clear(&mut self) {
        self.replaced.clear();
        self.parts.clear();
    }
}

impl Keep for Record {
    #[inline(always)]
    fn run(&mut self, place: usize) {
        self.parts.push(place);
    }

    #[inline(always)]
    unsafe fn register<const W: usize>(&mut self, memory: *const f64, register: u32) {
        // SAFETY: the memory has the register (the caller's promise), and a register has `W` values.
        let values = unsafe { memory.add(register as usize * W).cast::<[f64; W]>().read() };
        self.replaced.extend_from_slice(&values);
    }
}
