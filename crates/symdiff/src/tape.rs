//! Tapes: straight-line programs of three-address instructions over slots.

use crate::expr::{Binary, Unary};

/// What an instruction does with the slots a, b, c.
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
    /// d = sin a, b = cos a: `b` is written.
    SinCos,
}

impl Op {
    /// Slots that an instruction of this operation names: d, then what it reads (and, for `SinCos`, also writes).
    pub(crate) const fn arity(self) -> usize {
        match self {
            Self::Copy | Self::Unary(_) => 2,
            Self::Binary(_) | Self::SinCos => 3,
            Self::MulAdd | Self::MulSub | Self::NegMulAdd => 4,
        }
    }
}

/// Slots of one instruction; what an operation does not use repeats `a`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Operands {
    pub a: u32,
    pub b: u32,
    pub c: u32,
    pub d: u32,
}

impl Operands {
    /// From what a tape holds of them: d, a, and then as many as the operation has.
    #[inline(always)]
    pub(crate) fn of(slots: &[u32]) -> Self {
        let a = slots[1];
        let or_a = |place: usize| slots.get(place).copied().unwrap_or(a);
        Self { a, b: or_a(2), c: or_a(3), d: slots[0] }
    }
}

/// Instructions of one operation that stand together: one dispatch serves them all.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Run {
    op: Op,
    /// Range of the tape's operands.
    start: usize,
    end: usize,
}

/// A straight-line program. Every slot it names is below [`Tape::slots`], which is what the evaluators rely on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tape {
    runs: Vec<Run>,
    /// Slots of all instructions, no more of each than it has: a large mechanism's tape is read from far away.
    operands: Vec<u32>,
    instructions: usize,
    slots: usize,
}

impl Tape {
    /// A tape of these instructions in this order.
    pub fn new(instructions: impl IntoIterator<Item = (Op, Operands)>) -> Self {
        let mut tape = Self::default();
        for (op, Operands { a, b, c, d }) in instructions {
            let start = tape.operands.len();
            tape.operands.extend_from_slice(&[d, a, b, c][..op.arity()]);
            tape.instructions += 1;
            let end = tape.operands.len();
            match tape.runs.last_mut() {
                Some(run) if run.op == op => run.end = end,
                _ => tape.runs.push(Run { op, start, end }),
            }
            tape.slots = tape.operands[start..].iter().fold(tape.slots, |slots, &slot| slots.max(slot as usize + 1));
        }
        tape
    }

    /// Number of instructions.
    pub fn len(&self) -> usize {
        self.instructions
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.instructions == 0
    }

    /// One more than the highest slot named.
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// The instructions, grouped: slots of all of a run, [`Op::arity`] each.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Op, &[u32])> {
        self.runs.iter().map(|run| (run.op, &self.operands[run.start..run.end]))
    }
}
