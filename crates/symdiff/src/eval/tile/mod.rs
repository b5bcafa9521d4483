//! The evaluator: a tape over a tile of samples, structure of arrays.
//!
//! One dispatch serves all instructions of a run and all lanes of the tile. Every lane sees the same IEEE operations in
//! the same order for every width and instruction set: Rust contracts nothing, and sine and cosine are our own.

mod record;

use std::ops::Range;

use crate::eval::functions;
use crate::eval::sincos;
use crate::eval::vectorised::{InstructionSet, Vectorise};
use crate::expr::{Binary, Unary};
use crate::lower::tape::{Instructions, Op, Region, Tape, TapePart};

pub(crate) use record::Record;
use record::{Keep, Nothing};

/// Widths that a tile can have.
pub const WIDTHS: [usize; 6] = [1, 4, 8, 16, 32, 64];

/// Cache-line aligned storage, so that no vector load crosses a line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Line([f64; 8]);

/// Memory of a program for `width` samples: `registers` rows of `width` lanes.
#[derive(Clone, Debug)]
pub struct Tile {
    width: usize,
    registers: usize,
    lines: Vec<Line>,
}

impl Tile {
    /// Zeros, with `constants` set.
    ///
    /// # Panics
    /// If `width` is not one of [`WIDTHS`].
    pub fn new(width: usize, registers: usize, constants: &[(u32, f64)]) -> Self {
        assert!(WIDTHS.contains(&width), "a tile is one of {WIDTHS:?} wide");
        let mut tile = Self { width, registers, lines: vec![Line([0.0; 8]); (registers * width).div_ceil(8)] };
        for &(register, value) in constants {
            tile.lane_mut(register as usize).fill(value);
        }
        tile
    }

    /// Number of samples.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of registers.
    #[inline]
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// The memory, slot by slot.
    #[inline]
    pub fn values(&self) -> &[f64] {
        // SAFETY: `Line` is `repr(C)` around `[f64; 8]`, so the lines are `8 · len` consecutive f64.
        let all = unsafe { std::slice::from_raw_parts(self.lines.as_ptr().cast::<f64>(), self.lines.len() * 8) };
        &all[..self.registers * self.width]
    }

    /// The memory, slot by slot.
    #[inline]
    pub fn values_mut(&mut self) -> &mut [f64] {
        // SAFETY: as in `values`; the borrow is exclusive.
        let all =
            unsafe { std::slice::from_raw_parts_mut(self.lines.as_mut_ptr().cast::<f64>(), self.lines.len() * 8) };
        &mut all[..self.registers * self.width]
    }

    /// The values of consecutive registers, register by register.
    #[inline]
    pub fn block(&self, registers: Range<usize>) -> &[f64] {
        &self.values()[registers.start * self.width..registers.end * self.width]
    }

    /// The values of consecutive registers, register by register.
    #[inline]
    pub fn block_mut(&mut self, registers: Range<usize>) -> &mut [f64] {
        let width = self.width;
        &mut self.values_mut()[registers.start * width..registers.end * width]
    }

    /// A register's value in every sample.
    #[inline]
    pub fn lane(&self, register: usize) -> &[f64] {
        &self.values()[register * self.width..][..self.width]
    }

    /// A register's value in every sample.
    #[inline]
    pub fn lane_mut(&mut self, register: usize) -> &mut [f64] {
        let width = self.width;
        &mut self.values_mut()[register * width..][..width]
    }

    /// Runs a tape over all samples.
    ///
    /// # Panics
    /// If the tape names a register that the tile does not have.
    pub fn run(&mut self, tape: &Tape) {
        self.run_with(tape, InstructionSet::detect());
    }

    fn run_with(&mut self, tape: &Tape, set: InstructionSet) {
        self.interpret(tape, set, &mut Nothing);
    }

    /// Runs a tape likewise, and records the values that it replaces.
    pub(crate) fn run_recorded(&mut self, tape: &Tape, record: &mut Record) {
        record.begin(tape, self.width);
        self.interpret(tape, InstructionSet::detect(), record);
    }

    fn interpret(&mut self, tape: &Tape, set: InstructionSet, keep: &mut impl Keep) {
        assert!(tape.registers() <= self.registers, "the tape belongs to a larger memory");
        let memory = self.lines.as_mut_ptr().cast::<f64>();
        // The memory has `registers · width` values and the tape's registers are below `self.registers`: just asserted,
        // and `Tape::registers` is computed from the instructions. `Interpretation` relies on it.
        match self.width {
            1 => set.run(Interpretation::<1, 1, _> { tape, memory, keep }),
            4 => set.run(Interpretation::<4, 4, _> { tape, memory, keep }),
            8 => set.run(Interpretation::<8, 8, _> { tape, memory, keep }),
            16 => set.run(Interpretation::<16, 8, _> { tape, memory, keep }),
            32 => set.run(Interpretation::<32, 8, _> { tape, memory, keep }),
            _ => set.run(Interpretation::<64, 8, _> { tape, memory, keep }),
        }
    }
}

/// A tape to be run over `W` lanes in chunks of `C`.
struct Interpretation<'t, const W: usize, const C: usize, K> {
    tape: &'t Tape,
    memory: *mut f64,
    keep: &'t mut K,
}

impl<const W: usize, const C: usize, K: Keep> Vectorise for Interpretation<'_, W, C, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        // SAFETY: the maker of this has ensured that the memory has all registers of the tape.
        unsafe { interpret::<W, C, K>(self.tape, self.memory, self.keep) }
    }
}

/// `W` lanes in chunks of `C`. A chunk's operands are loaded before its result is stored, so that a result may replace
/// an operand.
#[inline(always)]
unsafe fn interpret<const W: usize, const C: usize, K: Keep>(tape: &Tape, memory: *mut f64, keep: &mut K) {
    let mut index = 0;
    while let Some(part) = tape.part(&mut index) {
        let (op, run) = match part {
            TapePart::Run(op, run) => {
                keep.run(index - 1);
                (op, run)
            }
            TapePart::Region(region) => {
                // SAFETY: by the caller's contract.
                region.skip_unless(unsafe { wanted::<W>(region, memory) }, &mut index);
                continue;
            }
        };
        // SAFETY: by the caller's contract; `A` is each operation's arity.
        unsafe {
            match *op {
                Op::Copy => each::<W, C, 2, K>(run, memory, keep, |a, _, _| a),
                Op::MulAdd => each::<W, C, 4, K>(run, memory, keep, |a, b, c| a * b + c),
                Op::MulSub => each::<W, C, 4, K>(run, memory, keep, |a, b, c| a * b - c),
                Op::NegMulAdd => each::<W, C, 4, K>(run, memory, keep, |a, b, c| c - a * b),
                Op::Binary(Binary::Add) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| a + b),
                Op::Binary(Binary::Sub) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| a - b),
                Op::Binary(Binary::Mul) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| a * b),
                Op::Select => each::<W, C, 4, K>(run, memory, keep, functions::select),
                Op::Binary(Binary::Select) => {
                    each::<W, C, 3, K>(run, memory, keep, |a, b, _| functions::select(a, b, 0.0))
                }
                Op::Binary(Binary::SelectElse) => {
                    each::<W, C, 3, K>(run, memory, keep, |a, b, _| functions::select(a, 0.0, b))
                }
                Op::Binary(Binary::Min) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| functions::min(a, b)),
                Op::Binary(Binary::Max) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| functions::max(a, b)),
                Op::Binary(Binary::Div) => each::<W, C, 3, K>(run, memory, keep, |a, b, _| a / b),
                Op::Unary(Unary::Neg) => each::<W, C, 2, K>(run, memory, keep, |a, _, _| -a),
                Op::Unary(Unary::Abs) => each::<W, C, 2, K>(run, memory, keep, |a, _, _| a.abs()),
                Op::Unary(Unary::Sqrt) => each::<W, C, 2, K>(run, memory, keep, |a, _, _| a.sqrt()),
                Op::Unary(function) => each::<W, 1, 2, K>(run, memory, keep, |a, _, _| functions::unary(function, a)),
                Op::Binary(function) => {
                    each::<W, 1, 3, K>(run, memory, keep, |a, b, _| functions::binary(function, a, b))
                }
                Op::SinCos => sin_cos::<W, C, K>(run, memory, keep),
            }
        }
    }
}

/// `d = function(a, b, c)` for each instruction (of `A` registers) and lane.
#[inline(always)]
unsafe fn each<const W: usize, const C: usize, const A: usize, K: Keep>(
    run: Instructions<'_>,
    memory: *mut f64,
    keep: &mut K,
    function: impl Fn(f64, f64, f64) -> f64,
) {
    // SAFETY: `A` is the operation's arity (the caller's promise).
    for operand in unsafe { run.of::<A>() } {
        // SAFETY: registers are in range (the caller's promise).
        unsafe { keep.register::<W>(memory, operand.d) };
        let mut lane = 0;
        while lane < W {
            // SAFETY: registers are in range (the caller's promise) and `lane + C ≤ W`.
            unsafe {
                let a = memory.add(operand.a as usize * W + lane).cast::<[f64; C]>().read();
                let b = memory.add(operand.b as usize * W + lane).cast::<[f64; C]>().read();
                let c = memory.add(operand.c as usize * W + lane).cast::<[f64; C]>().read();
                let mut d = [0.0; C];
                for i in 0..C {
                    d[i] = function(a[i], b[i], c[i]);
                }
                memory.add(operand.d as usize * W + lane).cast::<[f64; C]>().write(d);
            }
            lane += C;
        }
    }
}

/// Whether any lane wants a region.
#[inline(always)]
unsafe fn wanted<const W: usize>(region: &Region, memory: *mut f64) -> bool {
    // SAFETY: registers are in range (the caller's promise).
    let condition = unsafe { memory.add(region.condition as usize * W).cast::<[f64; W]>().read() };
    condition.iter().fold(false, |wanted, &condition| wanted | region.wants(condition))
}

/// `d = sin a`, `b = cos a` for each instruction and lane.
#[inline(always)]
unsafe fn sin_cos<const W: usize, const C: usize, K: Keep>(run: Instructions<'_>, memory: *mut f64, keep: &mut K) {
    // SAFETY: the operation's arity (the run is one of it, the caller's promise).
    for operand in unsafe { run.of::<{ Op::SinCos.arity() }>() } {
        // SAFETY: registers are in range (the caller's promise).
        unsafe {
            keep.register::<W>(memory, operand.d);
            keep.register::<W>(memory, operand.b);
        }
        let mut lane = 0;
        while lane < W {
            // SAFETY: as in `each`.
            unsafe {
                let a = memory.add(operand.a as usize * W + lane).cast::<[f64; C]>().read();
                let (sine, cosine) = sincos::sin_cos_lanes(&a);
                memory.add(operand.d as usize * W + lane).cast::<[f64; C]>().write(sine);
                memory.add(operand.b as usize * W + lane).cast::<[f64; C]>().write(cosine);
            }
            lane += C;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Expr, Graph, Input, Outputs, Spline, lower};

    fn sample() -> (Graph, Vec<Input>, Outputs) {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (s, c) = (g.sin(x), g.cos(x));
        let product = g.mul(s, y);
        let sum = g.add(product, c);
        let quotient = g.div(sum, y);
        let tangent = g.unary(Unary::Tan, quotient);
        let square = g.mul(sum, sum);
        let root = g.sqrt(square);
        let smaller = g.binary(Binary::Min, root, tangent);
        let table = Spline::through(&[(-2.0, 1.0), (0.5, 3.0), (1.0, -2.0), (4.0, 0.3)]).unwrap();
        let looked_up = g.unary(Unary::Spline(table, 0), smaller);
        let slope = g.unary(Unary::Spline(table, 1), product);
        let smaller = g.mul(looked_up, slope);
        let last = g.sub(smaller, product);
        let inputs = [(x, 0), (y, 1)].map(|(symbol, register)| Input { symbol, stage: 0, register }).to_vec();
        (g, inputs, vec![(sum, None), (tangent, None), (last, None), (s, None)])
    }

    #[test]
    fn all_widths_and_instruction_sets_give_equal_bits() {
        let (g, inputs, outputs) = sample();
        let lowered = lower(&g, &inputs, 0, 2, std::slice::from_ref(&outputs));
        let roots: Vec<Expr> = outputs.iter().map(|&(expr, _)| expr).collect();
        let mut sets = vec![InstructionSet::Baseline, InstructionSet::detect()];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            sets.push(InstructionSet::Avx2);
        }
        for width in WIDTHS {
            for &set in &sets {
                let mut tile = Tile::new(width, lowered.registers, &lowered.constants);
                let (x, y) = (|lane: usize| 0.37 * lane as f64 - 3.0, |lane: usize| 1.5 + 0.1 * lane as f64);
                for lane in 0..width {
                    tile.lane_mut(0)[lane] = x(lane);
                    tile.lane_mut(1)[lane] = y(lane);
                }
                tile.run_with(&lowered.kernels[0], set);
                for lane in 0..width {
                    let direct =
                        g.evaluate(&roots, |symbol| if symbol == inputs[0].symbol { x(lane) } else { y(lane) });
                    for (register, value) in lowered.outputs[0].iter().zip(direct) {
                        assert_eq!(tile.lane(*register as usize)[lane].to_bits(), value.to_bits(), "{width} {set:?}");
                    }
                }
            }
        }
    }
}
