//! Reverse mode: vector–Jacobian products of tapes, lane by lane.
//!
//! Each register has an adjoint, the derivative of one number by the register's value; every lane has a number of its
//! own. A tape is run and then followed backwards. An instruction d = f(a, b, c) moves the adjoint of its result to its
//! operands,
//!
//! ```text
//! ā += d̄ ∂f/∂a,   b̄ += d̄ ∂f/∂b,   c̄ += d̄ ∂f/∂c,   d̄ = 0,
//! ```
//!
//! and the register of d takes back the value that it had before. So a tape that solves a linear system with given
//! factors becomes, backwards, the transposed solve with the same factors; none is made anew.
//!
//! Kinks have the derivatives of [`Graph::derivative`](crate::Graph::derivative). Zero times anything is zero: what
//! does not count has no derivative, whether its own slope is finite or not. This is also why lanes that a region of a
//! tape does not concern may hold any value there.
//!
//! Griewank & Walther, *Evaluating Derivatives* (2nd ed., 2008), ch. 3 and 4.

use crate::eval::functions;
use crate::eval::tile::{Record, Tile};
use crate::eval::vectorised::{Vectorise, vectorised};
use crate::expr::{Binary, Unary};
use crate::lower::tape::{Op, Operands, Part, Tape};

/// Adjoints of the registers of a [`Tile`]: for each register and lane the derivative of the lane's number by it.
#[derive(Clone, Debug)]
pub struct Adjoints {
    width: usize,
    values: Vec<f64>,
    record: Record,
}

impl Adjoints {
    /// Zeros for all registers of a tile.
    pub fn new(tile: &Tile) -> Self {
        Self { width: tile.width(), values: vec![0.0; tile.values().len()], record: Record::default() }
    }

    /// The adjoints of a register.
    pub fn lane(&self, register: usize) -> &[f64] {
        &self.values[register * self.width..][..self.width]
    }

    /// The adjoints of a register.
    pub fn lane_mut(&mut self, register: usize) -> &mut [f64] {
        &mut self.values[register * self.width..][..self.width]
    }

    /// The adjoints of consecutive registers, register by register.
    pub fn block(&self, registers: std::ops::Range<usize>) -> &[f64] {
        &self.values[registers.start * self.width..registers.end * self.width]
    }

    /// The adjoints of consecutive registers, register by register.
    pub fn block_mut(&mut self, registers: std::ops::Range<usize>) -> &mut [f64] {
        &mut self.values[registers.start * self.width..registers.end * self.width]
    }

    /// Pulls adjoints of what a tape makes back to what it reads. The tile holds the values that the tape reads, before
    /// and after.
    ///
    /// # Panics
    /// If the tape names a register that the tile does not have, or the tile is another one than these are of.
    pub fn pull(&mut self, tape: &Tape, tile: &mut Tile) {
        assert!(tile.width() == self.width && tile.values().len() == self.values.len(), "adjoints of another tile");
        tile.run_recorded(tape, &mut self.record);
        match self.width {
            1 => self.reverse::<1>(tape, tile),
            4 => self.reverse::<4>(tape, tile),
            8 => self.reverse::<8>(tape, tile),
            16 => self.reverse::<16>(tape, tile),
            32 => self.reverse::<32>(tape, tile),
            _ => self.reverse::<64>(tape, tile),
        }
    }

    fn reverse<const W: usize>(&mut self, tape: &Tape, tile: &mut Tile) {
        let Self { values: adjoints, record, .. } = self;
        vectorised(Reverse::<W> {
            tape,
            values: tile.values_mut().as_chunks_mut().0,
            adjoints: adjoints.as_chunks_mut().0,
            replaced: record.replaced.as_chunks().0,
            parts: &record.parts,
        });
    }
}

/// A tape to be followed backwards.
struct Reverse<'r, const W: usize> {
    tape: &'r Tape,
    values: &'r mut [[f64; W]],
    adjoints: &'r mut [[f64; W]],
    /// Replaced values that are not restored yet.
    replaced: &'r [[f64; W]],
    parts: &'r [usize],
}

/// The product, zero where a factor is.
#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl<const W: usize> Vectorise for Reverse<'_, W> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        for &place in self.parts.iter().rev() {
            let Some(Part::Run(op, operands)) = self.tape.part(&mut { place }) else { continue };
            match op {
                Op::Copy => self.each::<2>(operands, |_, _| [1.0, 0.0, 0.0]),
                Op::MulAdd => self.each::<4>(operands, |[a, b, _], _| [b, a, 1.0]),
                Op::MulSub => self.each::<4>(operands, |[a, b, _], _| [b, a, -1.0]),
                Op::NegMulAdd => self.each::<4>(operands, |[a, b, _], _| [-b, -a, 1.0]),
                Op::Select => self.each::<4>(operands, |[a, _, _], _| {
                    [0.0, functions::select(a, 1.0, 0.0), functions::select(a, 0.0, 1.0)]
                }),
                Op::SinCos => self.sin_cos(operands),
                Op::Binary(Binary::Add) => self.each::<3>(operands, |_, _| [1.0, 1.0, 0.0]),
                Op::Binary(Binary::Sub) => self.each::<3>(operands, |_, _| [1.0, -1.0, 0.0]),
                Op::Binary(Binary::Mul) => self.each::<3>(operands, |[a, b, _], _| [b, a, 0.0]),
                Op::Binary(Binary::Div) => self.each::<3>(operands, |[_, b, _], d| [1.0 / b, -(d / b), 0.0]),
                Op::Unary(Unary::Neg) => self.each::<2>(operands, |_, _| [-1.0, 0.0, 0.0]),
                Op::Unary(Unary::Sqrt) => self.each::<2>(operands, |_, d| [0.5 / d, 0.0, 0.0]),
                Op::Unary(function) => self.each::<2>(operands, |[a, _, _], d| [slope(function, a, d), 0.0, 0.0]),
                Op::Binary(function) => self.each::<3>(operands, |[a, b, _], d| {
                    let [by_a, by_b] = slopes(function, [a, b], d);
                    [by_a, by_b, 0.0]
                }),
            }
        }
    }
}

impl<const W: usize> Reverse<'_, W> {
    /// Takes back what an instruction wrote into a register. Returns what it was.
    #[inline(always)]
    fn restore(&mut self, register: u32) -> [f64; W] {
        let (&last, rest) = self.replaced.split_last().expect("each instruction was recorded as it ran");
        self.replaced = rest;
        std::mem::replace(&mut self.values[register as usize], last)
    }

    /// Takes the adjoints of a result.
    #[inline(always)]
    fn take(&mut self, register: u32) -> [f64; W] {
        std::mem::replace(&mut self.adjoints[register as usize], [0.0; W])
    }

    #[inline(always)]
    fn add(&mut self, register: u32, change: [f64; W]) {
        for (adjoint, change) in self.adjoints[register as usize].iter_mut().zip(change) {
            *adjoint += change;
        }
    }

    /// Instructions of one operation (of `A` registers), whose derivatives by a, b, c follow from these and the result.
    #[inline(always)]
    fn each<const A: usize>(&mut self, operands: &[u32], slopes: impl Fn([f64; 3], f64) -> [f64; 3]) {
        for Operands { a, b, c, d } in operands.chunks_exact(A).rev().map(Operands::of) {
            let (result, adjoint) = (self.restore(d), self.take(d));
            let [x, y, z] = [a, b, c].map(|register| self.values[register as usize]);
            let mut by = [[0.0; W]; 3];
            for lane in 0..W {
                let of_lane = slopes([x[lane], y[lane], z[lane]], result[lane]);
                for operand in 0..A - 1 {
                    by[operand][lane] = times(adjoint[lane], of_lane[operand]);
                }
            }
            for (register, change) in [a, b, c].into_iter().zip(by).take(A - 1) {
                self.add(register, change);
            }
        }
    }

    #[inline(always)]
    fn sin_cos(&mut self, operands: &[u32]) {
        for Operands { a, b, d, .. } in operands.chunks_exact(Op::SinCos.arity()).rev().map(Operands::of) {
            let (cosine, by_cosine) = (self.restore(b), self.take(b));
            let (sine, by_sine) = (self.restore(d), self.take(d));
            let mut change = [0.0; W];
            for lane in 0..W {
                change[lane] = times(by_sine[lane], cosine[lane]) - times(by_cosine[lane], sine[lane]);
            }
            self.add(a, change);
        }
    }
}

/// f'(a), where `value` = f(a).
fn slope(function: Unary, a: f64, value: f64) -> f64 {
    match function {
        Unary::Neg => -1.0,
        Unary::Sin => functions::unary(Unary::Cos, a),
        Unary::Cos => -functions::unary(Unary::Sin, a),
        Unary::Tan => 1.0 + value * value,
        Unary::Asin => 1.0 / ((1.0 - a) * (1.0 + a)).sqrt(),
        Unary::Acos => -1.0 / ((1.0 - a) * (1.0 + a)).sqrt(),
        Unary::Atan => 1.0 / (1.0 + a * a),
        Unary::Sqrt => 0.5 / value,
        Unary::Exp => value,
        Unary::Log => 1.0 / a,
        Unary::Abs => functions::sign(a),
        Unary::Tanh => 1.0 - value * value,
        Unary::Sign | Unary::Floor => 0.0,
        Unary::Spline(spline, order) => spline.taylor(order, a)[1],
    }
}

/// The derivatives of f(a, b) by a and b, where `value` = f(a, b).
fn slopes(function: Binary, [a, b]: [f64; 2], value: f64) -> [f64; 2] {
    let wins = |first: bool| if first { [1.0, 0.0] } else { [0.0, 1.0] };
    match function {
        Binary::Add => [1.0, 1.0],
        Binary::Sub => [1.0, -1.0],
        Binary::Mul => [b, a],
        Binary::Div => [1.0 / b, -(value / b)],
        Binary::Pow => {
            let power = |exponent: f64| functions::binary(Binary::Pow, a, exponent);
            [times(b, power(b - 1.0)), times(value, functions::unary(Unary::Log, a))]
        }
        Binary::Atan2 => {
            let square = a * a + b * b;
            [b / square, -a / square]
        }
        Binary::Min | Binary::Max if a == b => [0.5, 0.5],
        Binary::Min => wins(a < b),
        Binary::Max => wins(a > b),
        Binary::Select => [0.0, functions::select(a, 1.0, 0.0)],
        Binary::SelectElse => [0.0, functions::select(a, 0.0, 1.0)],
    }
}
