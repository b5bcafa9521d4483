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
//! Kinks have the derivatives of [`Graph::derivative`](crate::Graph::derivative). Zero times anything is zero: a value
//! without influence has no derivative, whether its own slope is finite or not. For the same reason, lanes outside of a
//! region of a tape may have any value there.
//!
//! Griewank & Walther, *Evaluating Derivatives* (2nd ed., 2008), ch. 3 and 4.

use crate::eval::functions;
use crate::eval::tile::{Record, Tile};
use crate::eval::vectorised::{Vectorise, vectorised};
use crate::expr::{Binary, Unary};
use crate::lower::tape::{Instructions, Op, Operands, Tape, TapePart};

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

    /// Pulls adjoints of a tape's results back to its operands. The tile has the values that the tape reads, before and
    /// after.
    ///
    /// # Panics
    /// If the tape names a register that the tile does not have, or the tile is not the one of these adjoints.
    pub fn pull(&mut self, tape: &Tape, tile: &mut Tile) {
        self.record(tape, tile);
        self.pull_last(tape, tile);
    }

    /// Runs a tape that [`pull_last`](Self::pull_last) follows backwards later. Tapes recorded after it are followed
    /// before it; in between, only these tapes change the tile's registers, or the registers return to their values.
    ///
    /// # Panics
    /// As [`pull`](Self::pull).
    pub fn record(&mut self, tape: &Tape, tile: &mut Tile) {
        assert!(tile.width() == self.width && tile.values().len() == self.values.len(), "adjoints of another tile");
        tile.run_recorded(tape, &mut self.record);
    }

    /// Pulls adjoints back through the tape that was recorded last.
    ///
    /// # Panics
    /// If it is another tape, or the tile is not the one of these adjoints.
    pub fn pull_last(&mut self, tape: &Tape, tile: &mut Tile) {
        assert!(tile.width() == self.width && tile.values().len() == self.values.len(), "adjoints of another tile");
        let (replaced, parts) = self.record.last();
        assert!(tape.registers() <= tile.registers() && replaced.len() <= tape.written() * self.width);
        let (memory, adjoints) = (tile.values_mut().as_mut_ptr(), self.values.as_mut_ptr());
        match self.width {
            1 => vectorised(Reverse::<1, 1> { tape, memory, adjoints, replaced, parts }),
            4 => vectorised(Reverse::<4, 4> { tape, memory, adjoints, replaced, parts }),
            8 => vectorised(Reverse::<8, 8> { tape, memory, adjoints, replaced, parts }),
            16 => vectorised(Reverse::<16, 8> { tape, memory, adjoints, replaced, parts }),
            32 => vectorised(Reverse::<32, 8> { tape, memory, adjoints, replaced, parts }),
            _ => vectorised(Reverse::<64, 8> { tape, memory, adjoints, replaced, parts }),
        }
        self.record.end();
    }
}

/// A tape to be followed backwards over `W` lanes in chunks of `C`. Values and adjoints have all registers of the tape.
struct Reverse<'r, const W: usize, const C: usize> {
    tape: &'r Tape,
    memory: *mut f64,
    adjoints: *mut f64,
    /// Replaced values that are not restored yet.
    replaced: &'r [f64],
    parts: &'r [usize],
}

/// `C` lanes of a register from lane `lane`, in a memory of `W` lanes.
///
/// # Safety
/// The memory has the register, and `lane + C ≤ W`.
#[inline(always)]
unsafe fn chunk<const W: usize, const C: usize>(memory: *mut f64, register: u32, lane: usize) -> *mut [f64; C] {
    // SAFETY: by the caller's contract.
    unsafe { memory.add(register as usize * W + lane).cast() }
}

/// Adds to a chunk.
///
/// # Safety
/// The chunk is one of [`chunk`].
#[inline(always)]
unsafe fn add<const C: usize>(sum: *mut [f64; C], change: &[f64; C]) {
    // SAFETY: by the caller's contract.
    unsafe {
        let mut values = sum.read();
        for i in 0..C {
            values[i] += change[i];
        }
        sum.write(values);
    }
}

/// The product, zero if a factor is.
#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl<const W: usize, const C: usize> Vectorise for Reverse<'_, W, C> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        for &index in self.parts.iter().rev() {
            let Some(TapePart::Run(op, run)) = self.tape.part(&mut { index }) else { continue };
            // SAFETY: `A` is each operation's arity.
            unsafe {
                match *op {
                    Op::Copy => self.each::<2>(run, |_, _, by| [by, 0.0, 0.0]),
                    Op::MulAdd => self.each::<4>(run, |[a, b, _], _, by| [times(by, b), times(by, a), by]),
                    Op::MulSub => self.each::<4>(run, |[a, b, _], _, by| [times(by, b), times(by, a), -by]),
                    Op::NegMulAdd => self.each::<4>(run, |[a, b, _], _, by| [-times(by, b), -times(by, a), by]),
                    Op::Select => self.each::<4>(run, |[a, _, _], _, by| {
                        [0.0, functions::select(a, by, 0.0), functions::select(a, 0.0, by)]
                    }),
                    Op::SinCos => self.sin_cos(run),
                    Op::Binary(Binary::Add) => self.each::<3>(run, |_, _, by| [by, by, 0.0]),
                    Op::Binary(Binary::Sub) => self.each::<3>(run, |_, _, by| [by, -by, 0.0]),
                    Op::Binary(Binary::Mul) => {
                        self.each::<3>(run, |[a, b, _], _, by| [times(by, b), times(by, a), 0.0])
                    }
                    Op::Binary(Binary::Div) => self.each::<3>(run, |[_, b, _], d, by| {
                        let by_a = times(by, 1.0 / b);
                        [by_a, -times(by_a, d), 0.0]
                    }),
                    Op::Unary(Unary::Neg) => self.each::<2>(run, |_, _, by| [-by, 0.0, 0.0]),
                    Op::Unary(Unary::Sqrt) => self.each::<2>(run, |_, d, by| [times(by, 0.5 / d), 0.0, 0.0]),
                    Op::Unary(function) => {
                        self.each::<2>(run, |[a, _, _], d, by| [times(by, slope(function, a, d)), 0.0, 0.0]);
                    }
                    Op::Binary(function) => self.each::<3>(run, |[a, b, _], d, by| {
                        let [by_a, by_b] = slopes(function, [a, b], d);
                        [times(by, by_a), times(by, by_b), 0.0]
                    }),
                }
            }
        }
    }
}

impl<const W: usize, const C: usize> Reverse<'_, W, C> {
    /// The values of the register to restore next.
    #[inline(always)]
    fn next(&mut self) -> &[f64] {
        let (rest, last) = self.replaced.split_at(self.replaced.len() - W);
        self.replaced = rest;
        last
    }

    /// Pulls instructions of one operation back: shares of a, b, c in the adjoint of a result.
    ///
    /// # Safety
    /// The operation has `A` registers.
    #[inline(always)]
    unsafe fn each<const A: usize>(&mut self, run: Instructions<'_>, shares: impl Fn([f64; 3], f64, f64) -> [f64; 3]) {
        let (memory, adjoints) = (self.memory, self.adjoints);
        // SAFETY: by the caller's contract.
        for Operands { a, b, c, d } in unsafe { run.of::<A>() }.rev() {
            let restored = self.next().as_ptr();
            let mut lane = 0;
            while lane < W {
                // SAFETY: values and adjoints have all registers of the tape (ensured by the maker of this), the
                // restored values are those of `W` lanes, and `lane + C ≤ W`.
                unsafe {
                    let result = chunk::<W, C>(memory, d, lane).read();
                    chunk::<W, C>(memory, d, lane).write(restored.add(lane).cast::<[f64; C]>().read());
                    let by = chunk::<W, C>(adjoints, d, lane).read();
                    chunk::<W, C>(adjoints, d, lane).write([0.0; C]);
                    let x = chunk::<W, C>(memory, a, lane).read();
                    let y = chunk::<W, C>(memory, b, lane).read();
                    let z = chunk::<W, C>(memory, c, lane).read();
                    let mut changes = [[0.0; C]; 3];
                    for i in 0..C {
                        let own = shares([x[i], y[i], z[i]], result[i], by[i]);
                        changes[0][i] = own[0];
                        changes[1][i] = own[1];
                        changes[2][i] = own[2];
                    }
                    add(chunk::<W, C>(adjoints, a, lane), &changes[0]);
                    if A > 2 {
                        add(chunk::<W, C>(adjoints, b, lane), &changes[1]);
                    }
                    if A > 3 {
                        add(chunk::<W, C>(adjoints, c, lane), &changes[2]);
                    }
                }
                lane += C;
            }
        }
    }

    /// Pulls instructions of [`Op::SinCos`] back.
    ///
    /// # Safety
    /// The run has that operation.
    #[inline(always)]
    unsafe fn sin_cos(&mut self, run: Instructions<'_>) {
        let (memory, adjoints) = (self.memory, self.adjoints);
        // SAFETY: by the caller's contract.
        for Operands { a, b, d, .. } in unsafe { run.of::<{ Op::SinCos.arity() }>() }.rev() {
            let cosine_before = self.next().as_ptr();
            let sine_before = self.next().as_ptr();
            for lane in 0..W {
                let at = |register: u32| register as usize * W + lane;
                // SAFETY: as in `each`.
                unsafe {
                    let (sine, cosine) = (memory.add(at(d)).read(), memory.add(at(b)).read());
                    memory.add(at(b)).write(cosine_before.add(lane).read());
                    memory.add(at(d)).write(sine_before.add(lane).read());
                    let by_cosine = adjoints.add(at(b)).replace(0.0);
                    let by_sine = adjoints.add(at(d)).replace(0.0);
                    *adjoints.add(at(a)) += times(by_sine, cosine) - times(by_cosine, sine);
                }
            }
        }
    }
}

/// f'(a), given `value` = f(a).
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

/// The derivatives of f(a, b) by a and b, given `value` = f(a, b).
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
