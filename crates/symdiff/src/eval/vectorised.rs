//! One source, compiled for every instruction set and chosen at run time.

/// Work worth compiling for wide vectors. Mark `run` `#[inline(always)]`, so that it is inlined into functions that may
/// use them. Rust contracts and reorders nothing, so the results are the same to the bit.
pub trait Vectorise {
    /// Result.
    type Output;
    /// Does the work.
    fn run(self) -> Self::Output;
}

/// Does the work with the best instruction set of this machine.
#[inline]
pub fn vectorised<W: Vectorise>(work: W) -> W::Output {
    InstructionSet::detect().run(work)
}

/// Work over the lanes of a tile that is worth compiling for every width: its loops are over arrays of `W` values.
pub trait LaneWork {
    /// Does the work. Mark it `#[inline(always)]`, as `run` of [`Vectorise`].
    fn run<const W: usize>(self);
}

/// Does the work over the lanes of a tile of this width, one of [`WIDTHS`](crate::WIDTHS).
#[inline]
pub fn in_lanes<L: LaneWork>(width: usize, work: L) {
    match width {
        1 => vectorised(OfWidth::<1, L>(work)),
        4 => vectorised(OfWidth::<4, L>(work)),
        8 => vectorised(OfWidth::<8, L>(work)),
        16 => vectorised(OfWidth::<16, L>(work)),
        32 => vectorised(OfWidth::<32, L>(work)),
        _ => vectorised(OfWidth::<64, L>(work)),
    }
}

/// Work over `W` lanes.
struct OfWidth<const W: usize, L>(L);

impl<const W: usize, L: LaneWork> Vectorise for OfWidth<W, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.run::<W>();
    }
}

/// Values of all `W` lanes.
///
/// # Panics
/// If there are fewer.
#[inline(always)]
pub fn lanes<const W: usize, T>(values: &[T]) -> &[T; W] {
    values.first_chunk().expect("there is a value for each lane")
}

/// Mutable values of all `W` lanes.
///
/// # Panics
/// If there are fewer.
#[inline(always)]
pub fn lanes_mut<const W: usize, T>(values: &mut [T]) -> &mut [T; W] {
    values.first_chunk_mut().expect("there is a value for each lane")
}

/// Name of the instruction set that [`vectorised`] uses on this machine.
pub fn instruction_set() -> &'static str {
    match InstructionSet::detect() {
        InstructionSet::Baseline => "of every processor of this kind",
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => "AVX2",
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => "AVX-512",
    }
}

/// An instruction set that this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InstructionSet {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl InstructionSet {
    /// The best one; `is_x86_feature_detected` caches its answer.
    #[inline]
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    #[inline]
    pub(crate) fn run<W: Vectorise>(self, work: W) -> W::Output {
        match self {
            Self::Baseline => work.run(),
            // SAFETY: a set is only made if the machine has it.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { with_avx2(work) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { with_avx512(work) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<W: Vectorise>(work: W) -> W::Output {
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
fn with_avx512<W: Vectorise>(work: W) -> W::Output {
    work.run()
}
