//! Tapes: straight-line programs of three-address instructions over registers, with regions that may be skipped.
//!
//! The values of a region only matter where a condition is positive (or only where it is not). A region is skipped if
//! no sample of the memory wants it. That changes no result: a value read outside a region is chosen, sample by sample,
//! by [`Op::Select`] and its kin, which take nothing of a region from a sample that does not want it.

use crate::expr::{Binary, Expr, Unary};

/// Operation of an instruction on the registers a, b, c.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// d = a
    Copy,
    /// d = f(a); never `Sin` or `Cos`, which are `SinCos`.
    Unary(Unary),
    /// d = f(a, b)
    Binary(Binary),
    /// d = a·b + c, rounded twice.
    MulAdd,
    /// d = a·b − c, rounded twice.
    MulSub,
    /// d = c − a·b, rounded twice.
    NegMulAdd,
    /// d = b where a is positive or NaN, c elsewhere.
    Select,
    /// d = sin a, b = cos a: `b` is written.
    SinCos,
}

impl Op {
    /// The number of registers in an instruction of this operation: d, then its operands (and, for `SinCos`, also
    /// writes).
    pub(crate) const fn arity(self) -> usize {
        match self {
            Self::Copy | Self::Unary(_) => 2,
            Self::Binary(_) | Self::SinCos => 3,
            Self::MulAdd | Self::MulSub | Self::NegMulAdd | Self::Select => 4,
        }
    }
}

/// Registers of one instruction; unused operands repeat `a`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operands {
    /// Register of the first operand.
    pub a: u32,
    /// Register of the second operand, or of the first if there is none.
    pub b: u32,
    /// Register of the third operand, or of the first if there is none.
    pub c: u32,
    /// Register of the result.
    pub d: u32,
}

impl Operands {
    /// From the registers on a tape: d, a, and then further operands of the operation.
    #[inline(always)]
    pub(crate) fn of(registers: &[u32]) -> Self {
        let a = registers[1];
        let or_a = |index: usize| registers.get(index).copied().unwrap_or(a);
        Self { a, b: or_a(2), c: or_a(3), d: registers[0] }
    }
}

/// Condition under which a value is wanted: where `condition` is positive, or where it is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Guard {
    /// The condition.
    pub condition: Expr,
    /// Whether it is wanted where the condition is *not* positive.
    pub elsewhere: bool,
}

/// A stretch of a tape that may be skipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Region {
    /// Register of the condition.
    pub condition: u32,
    elsewhere: bool,
    /// Part of the tape that follows the region.
    end: usize,
}

impl Region {
    /// Whether a sample with this condition wants the region.
    #[inline(always)]
    pub fn wants(&self, condition: f64) -> bool {
        (condition <= 0.0) == self.elsewhere
    }

    /// Whether it is wanted where the condition is not positive.
    pub fn is_elsewhere(&self) -> bool {
        self.elsewhere
    }

    /// Part of the tape that follows it.
    pub fn end(&self) -> usize {
        self.end
    }

    /// Moves to its end if no sample wants it.
    #[inline(always)]
    pub fn skip_unless(&self, wanted: bool, index: &mut usize) {
        if !wanted {
            *index = self.end;
        }
    }
}

/// Consecutive instructions of one operation (one dispatch serves them all), or the beginning of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Piece {
    Run {
        op: Op,
        /// Index of the run's first register in the tape's operands.
        start: usize,
        count: usize,
    },
    Region(Region),
}

/// Instructions of one operation, or the beginning of a region.
pub(crate) enum TapePart<'t> {
    Run(&'t Op, Instructions<'t>),
    Region(&'t Region),
}

/// Registers of instructions of one operation, [`Op::arity`] of each.
#[derive(Clone, Copy)]
pub(crate) struct Instructions<'t> {
    /// Registers of the run, and of all that follow.
    registers: &'t [u32],
    count: usize,
}

impl<'t> Instructions<'t> {
    /// Instructions of this operation, which is the run's.
    pub fn each(self, op: Op) -> impl Iterator<Item = Operands> {
        self.registers.chunks_exact(op.arity()).take(self.count).map(Operands::of)
    }

    /// Instructions of operations of `A` registers, without the division that computes their number.
    ///
    /// # Safety
    /// The run's operation has `A` registers.
    #[inline(always)]
    pub unsafe fn of<const A: usize>(self) -> impl DoubleEndedIterator<Item = Operands> + use<'t, A> {
        debug_assert!(self.count * A <= self.registers.len(), "a tape has all registers of its runs");
        // SAFETY: `Tape::new` counts the instructions whose registers it adds, and each has `A` of them.
        let registers = unsafe { std::slice::from_raw_parts(self.registers.as_ptr().cast::<[u32; A]>(), self.count) };
        registers.iter().map(|registers| Operands::of(registers))
    }
}

/// Input of [`Tape::new`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    Do(Op, Operands),
    /// A region begins; its condition's register, and whether it is wanted elsewhere.
    Enter(u32, bool),
    /// The innermost region ends.
    Leave,
}

/// A program. Every register in it is below [`Tape::registers`], on which the evaluators rely.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tape {
    pieces: Vec<Piece>,
    /// Registers of all instructions, only those that each has: a large mechanism's tape is read from distant memory.
    operands: Vec<u32>,
    instructions: usize,
    registers: usize,
}

impl Tape {
    /// A tape of these items in this order.
    ///
    /// # Panics
    /// If a region ends that has not begun: a defect of the caller.
    pub(crate) fn new(items: impl IntoIterator<Item = Item>) -> Self {
        let mut tape = Self::default();
        let mut open = Vec::new();
        let mut joined = false;
        for item in items {
            match item {
                Item::Do(op, Operands { a, b, c, d }) => {
                    let start = tape.operands.len();
                    tape.operands.extend_from_slice(&[d, a, b, c][..op.arity()]);
                    tape.instructions += 1;
                    match tape.pieces.last_mut() {
                        Some(Piece::Run { op: last, count, .. }) if *last == op && joined => *count += 1,
                        _ => tape.pieces.push(Piece::Run { op, start, count: 1 }),
                    }
                    joined = true;
                    tape.registers = tape.operands[start..]
                        .iter()
                        .fold(tape.registers, |registers, &register| registers.max(register as usize + 1));
                }
                Item::Enter(condition, elsewhere) => {
                    open.push(tape.pieces.len());
                    tape.pieces.push(Piece::Region(Region { condition, elsewhere, end: 0 }));
                    tape.registers = tape.registers.max(condition as usize + 1);
                }
                Item::Leave => {
                    let end = tape.pieces.len();
                    // Each `Leave` follows its `Enter`.
                    let start = open.pop().expect("each piece has a beginning");
                    if let Piece::Region(region) = &mut tape.pieces[start] {
                        region.end = end;
                    }
                    joined = false;
                }
            }
        }
        tape
    }

    /// Number of instructions.
    pub fn len(&self) -> usize {
        self.instructions
    }

    /// Number of instructions that run if all conditions are positive, or if none is.
    pub fn len_where(&self, positive: bool) -> usize {
        let (mut index, mut count) = (0, 0);
        while let Some(part) = self.part(&mut index) {
            match part {
                TapePart::Run(_, instructions) => count += instructions.count,
                TapePart::Region(region) => {
                    region.skip_unless(region.wants(if positive { 1.0 } else { 0.0 }), &mut index)
                }
            }
        }
        count
    }

    /// Number of instructions of the selected operations.
    pub fn count(&self, of: impl Fn(Op) -> bool) -> usize {
        let runs = self.pieces.iter().filter_map(|piece| match piece {
            Piece::Run { op, count, .. } if of(*op) => Some(*count),
            _ => None,
        });
        runs.sum()
    }

    /// Number of registers that instructions write, one after the other.
    pub(crate) fn written(&self) -> usize {
        self.instructions + self.count(|op| op == Op::SinCos)
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.instructions == 0
    }

    /// One more than the highest register named.
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// The part at an index, which moves on to the next.
    #[inline(always)]
    pub(crate) fn part(&self, index: &mut usize) -> Option<TapePart<'_>> {
        let piece = self.pieces.get(*index)?;
        *index += 1;
        Some(match piece {
            Piece::Run { op, start, count } => {
                // SAFETY: `new` adds the operands that begin there, and never removes any.
                let registers = unsafe { self.operands.get_unchecked(*start..) };
                TapePart::Run(op, Instructions { registers, count: *count })
            }
            Piece::Region(region) => TapePart::Region(region),
        })
    }
}
