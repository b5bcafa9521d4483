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

/// Slots of one instruction; what an operation does not use repeats `a`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Operands {
    pub a: u32,
    pub b: u32,
    pub c: u32,
    pub d: u32,
}

/// Instructions of one operation that stand together: one dispatch serves them all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) op: Op,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A straight-line program. Every slot it names is below [`Tape::slots`], which is what the evaluators rely on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tape {
    runs: Vec<Run>,
    operands: Vec<Operands>,
    slots: usize,
}

impl Tape {
    /// A tape of these instructions in this order.
    pub fn new(instructions: impl IntoIterator<Item = (Op, Operands)>) -> Self {
        let mut tape = Self::default();
        for (op, operands) in instructions {
            let place = tape.operands.len();
            match tape.runs.last_mut() {
                Some(run) if run.op == op => run.end = place + 1,
                _ => tape.runs.push(Run { op, start: place, end: place + 1 }),
            }
            let highest = operands.a.max(operands.b).max(operands.c).max(operands.d) as usize;
            tape.slots = tape.slots.max(highest + 1);
            tape.operands.push(operands);
        }
        tape
    }

    /// Number of instructions.
    pub fn len(&self) -> usize {
        self.operands.len()
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.operands.is_empty()
    }

    /// Number of dispatches: runs of equal operations.
    pub fn dispatches(&self) -> usize {
        self.runs.len()
    }

    /// One more than the highest slot named.
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// The instructions, grouped.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Op, &[Operands])> {
        self.runs.iter().map(|run| (run.op, &self.operands[run.start..run.end]))
    }
}
