//! The evaluator over jets: the same tapes, with a truncated polynomial in every slot.

use crate::eval::jet::{JetScratch, JetSpace};
use crate::lower::tape::{Op, Tape, TapePart};

/// Memory of a program for one sample whose values are polynomials in the uncertain parameters.
#[derive(Clone, Debug)]
pub struct JetMemory<'s> {
    space: &'s JetSpace,
    scratch: JetScratch,
    values: Vec<f64>,
    /// Results before they are stored: a result may replace an operand.
    first: Vec<f64>,
    second: Vec<f64>,
}

impl<'s> JetMemory<'s> {
    /// Zeros, with `constants` set.
    pub fn new(space: &'s JetSpace, registers: usize, constants: &[(u32, f64)]) -> Self {
        let length = space.len();
        let (first, second) = (vec![0.0; length], vec![0.0; length]);
        let mut memory =
            Self { space, scratch: JetScratch::new(space), values: vec![0.0; registers * length], first, second };
        for &(register, value) in constants {
            memory.set_constant(register as usize, value);
        }
        memory
    }

    /// The polynomial in a slot.
    pub fn jet(&self, register: usize) -> &[f64] {
        &self.values[register * self.space.len()..][..self.space.len()]
    }

    /// The polynomial in a slot.
    pub fn jet_mut(&mut self, register: usize) -> &mut [f64] {
        let length = self.space.len();
        &mut self.values[register * length..][..length]
    }

    /// A register becomes a constant.
    pub fn set_constant(&mut self, register: usize, value: f64) {
        let space = self.space;
        space.constant(value, self.jet_mut(register));
    }

    /// Runs a tape.
    ///
    /// # Panics
    /// If the tape names a register that the memory does not have.
    pub fn run(&mut self, tape: &Tape) {
        let length = self.space.len();
        let Self { space, scratch, values, first, second } = self;
        let mut index = 0;
        while let Some(part) = tape.part(&mut index) {
            let (op, run) = match part {
                TapePart::Run(op, run) => (*op, run),
                TapePart::Region(region) => {
                    let condition = values[region.condition as usize * length];
                    region.skip_unless(region.wants(condition), &mut index);
                    continue;
                }
            };
            for operand in run.each(op) {
                let jet = |register: u32| &values[register as usize * length..][..length];
                let (a, b, c) = (jet(operand.a), jet(operand.b), jet(operand.c));
                match op {
                    Op::Copy => first.copy_from_slice(a),
                    Op::MulAdd => space.mul_add(a, b, c, first),
                    Op::MulSub => space.mul_sub(a, b, c, first),
                    Op::NegMulAdd => space.sub_mul(a, b, c, first),
                    Op::Select => first.copy_from_slice(if a[0] <= 0.0 { c } else { b }),
                    Op::Unary(function) => space.unary(function, a, first, scratch),
                    Op::Binary(function) => space.binary(function, a, b, first, scratch),
                    Op::SinCos => {
                        space.sin_cos(a, first, second, scratch);
                        values[operand.b as usize * length..][..length].copy_from_slice(second);
                    }
                }
                values[operand.d as usize * length..][..length].copy_from_slice(first);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Graph, Input, lower};

    #[test]
    fn a_tape_over_jets_gives_the_taylor_coefficients() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (product, sine) = (g.mul(x, y), g.sin(x));
        let sum = g.add(product, sine);
        let inputs = [(x, 0), (y, 1)].map(|(symbol, register)| Input { symbol, stage: 0, register });
        let lowered = lower(&g, &inputs, 0, 2, &[vec![(sum, None)]]);
        let space = JetSpace::new(2, 2);
        let mut memory = JetMemory::new(&space, lowered.registers, &lowered.constants);
        space.variable(0, 0.5, 1.0, memory.jet_mut(0));
        space.variable(1, 2.0, 1.0, memory.jet_mut(1));
        memory.run(&lowered.kernels[0]);
        let jet = memory.jet(lowered.outputs[0][0] as usize);
        let at = |exponents: &[usize]| {
            let monomials = space.monomials();
            (0..space.len()).find(|&r| monomials.exponents(r) == exponents).map(|r| jet[r]).unwrap()
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} {b}");
        close(at(&[0, 0]), 1.0 + 0.5_f64.sin());
        close(at(&[1, 0]), 2.0 + 0.5_f64.cos());
        close(at(&[0, 1]), 0.5);
        close(at(&[1, 1]), 1.0);
        close(at(&[2, 0]), -0.5 * 0.5_f64.sin());
    }
}
