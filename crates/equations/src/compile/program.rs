//! A step's program: the tapes of one step of a scheme, and the registers of their results.

use symdiff::{Lowered, Tape};

use super::layout::Layout;
use super::scheme::Coefficients;
use super::tapes::Tapes;

/// A state that guides the choice of pivots: values of the layout's registers, at a step size.
#[derive(Clone, Debug, PartialEq)]
pub struct PivotSample {
    /// Values of the registers below `layout.registers()`.
    pub values: Vec<f64>,
}

/// A pivot that can change, and how small it may become before its factors are not trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedPivot {
    /// Register of 1/pivot.
    pub register: usize,
    /// Largest |1/pivot| that is trusted.
    pub largest_inverse: f64,
}

/// Lanes that solve with a version of the factors: determined by the active condition at the iterate of the
/// factorisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorMode {
    /// Register of the active condition.
    pub register: usize,
    /// Whether the lanes are those in which the condition is not positive.
    pub inactive: bool,
}

impl FactorMode {
    /// Whether a lane with this value of the condition is one of them.
    #[inline(always)]
    pub fn holds(&self, value: f64) -> bool {
        (value <= 0.0) == self.inactive
    }
}

/// The pivots of one version of the factors.
#[derive(Clone, Debug, PartialEq)]
pub struct WatchedPivots {
    /// Lanes that use the version; `None` for all, if there is one version.
    pub mode: Option<FactorMode>,
    /// The version's pivots that can change.
    pub pivots: Vec<WatchedPivot>,
}

/// Compiled form of a system for one scheme. A tile of samples has [`Program::registers`] registers.
#[derive(Clone, Debug)]
pub struct Program {
    /// The part of the memory that holds states.
    pub layout: Layout,
    /// The scheme's numbers.
    pub coefficients: Coefficients,
    /// Typical size of each coordinate, n.
    pub scale: Vec<f64>,
    /// Registers of the outputs after [`Program::observe`].
    pub outputs: Vec<usize>,
    /// Registers of the Newton matrix's entries (row, column, register) after [`Program::matrix`]. Rows and columns
    /// from n + m on are those of values of links, each by those before it.
    pub matrix_entries: Vec<(usize, usize, usize)>,
    /// Rows of the matrix that is eliminated: n + m, and those of values of links.
    pub size: usize,
    /// Registers of the residual after [`Program::matrix`], n + m.
    pub residual: Vec<usize>,
    /// Rounding error of each constraint near the pivot samples, m, in the constraint's unit; zero for a scheme of
    /// index 2.
    pub rounding: Vec<f64>,
    /// Registers of the multipliers of redundant constraints: undetermined reactions, which are taken as zero.
    pub redundant: Vec<usize>,
    /// Pivots that can become small, for each version of the factors.
    pub watched: Vec<WatchedPivots>,
    /// Symmetric scaling that equilibrates the Newton matrix, n + m.
    pub equilibration: Vec<f64>,
    /// Nonzeros of the Newton matrix and of its factors.
    pub nonzeros: (usize, usize),
    /// Equation and unknown of each pivot, in the order of elimination.
    pub pivots: Vec<(usize, usize)>,
    pub(super) lowered: Lowered,
}

pub(super) const FACTOR: usize = 0;
pub(super) const FIRST_CORRECTION: usize = 1;
pub(super) const CORRECT: usize = 2;
pub(super) const ADVANCE: usize = 3;
pub(super) const OBSERVE: usize = 4;
pub(super) const MATRIX: usize = 5;
pub(super) const ESTIMATE: usize = 6;

impl Tapes for Program {
    fn lowered(&self) -> &Lowered {
        &self.lowered
    }
}

impl Program {
    /// Once after a change of h.
    pub fn step_size(&self) -> &Tape {
        &self.lowered.stages[1]
    }

    /// Once a step, after `time` was set to t₊: the values that the iteration does not change.
    pub fn step(&self) -> &Tape {
        &self.lowered.stages[2]
    }

    /// Newton matrix at the iterate, factorised.
    pub fn factor(&self) -> &Tape {
        &self.lowered.kernels[FACTOR]
    }

    /// The same as [`correct`](Self::correct), after a factorisation at the same iterate.
    pub fn first_correction(&self) -> &Tape {
        &self.lowered.kernels[FIRST_CORRECTION]
    }

    /// Residual at the iterate and, with the last factors, the correction.
    pub fn correct(&self) -> &Tape {
        &self.lowered.kernels[CORRECT]
    }

    /// Replaces the state by the one at the step's end.
    pub fn advance(&self) -> &Tape {
        &self.lowered.kernels[ADVANCE]
    }

    /// Outputs of the state.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// Newton matrix and residual at the iterate, for the rank-revealing solve.
    pub fn matrix(&self) -> &Tape {
        &self.lowered.kernels[MATRIX]
    }

    /// Writes the part of a₊ − a that moves the mechanism into the correction's first n registers, J⁻¹(M (a₊ − a), 0),
    /// with the last factors: after the iteration, and before the state is advanced.
    pub fn estimate(&self) -> &Tape {
        &self.lowered.kernels[ESTIMATE]
    }

    /// Instructions of a step with one correction.
    pub fn instructions(&self) -> usize {
        [self.step(), self.factor(), self.first_correction(), self.advance()].into_iter().map(Tape::len).sum()
    }

    /// Registers that the factors occupy.
    pub fn factor_registers(&self) -> &[u32] {
        &self.lowered.outputs[FACTOR]
    }
}
