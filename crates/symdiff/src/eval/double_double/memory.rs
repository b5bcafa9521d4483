//! The evaluator over numbers of twice the digits: the same tapes, for one sample.

use super::DoubleDouble;
use super::functions::{binary, sin_cos, unary};
use crate::lower::tape::{Op, Tape, TapePart};

/// Memory of a program for one sample.
#[derive(Clone, Debug)]
pub struct DoubleDoubleMemory {
    values: Vec<DoubleDouble>,
}

impl DoubleDoubleMemory {
    /// Zeros, with `constants` set.
    pub fn new(registers: usize, constants: &[(u32, f64)]) -> Self {
        let mut values = vec![DoubleDouble::default(); registers];
        for &(register, value) in constants {
            values[register as usize] = value.into();
        }
        Self { values }
    }

    /// The number in a register.
    pub fn value(&self, register: usize) -> DoubleDouble {
        self.values[register]
    }

    /// Sets a register.
    pub fn set(&mut self, register: usize, value: DoubleDouble) {
        self.values[register] = value;
    }

    /// Runs a tape.
    ///
    /// # Panics
    /// If the tape names a register that the memory does not have.
    pub fn run(&mut self, tape: &Tape) {
        let values = &mut self.values;
        let mut index = 0;
        while let Some(part) = tape.part(&mut index) {
            let (op, run) = match part {
                TapePart::Run(op, run) => (*op, run),
                TapePart::Region(region) => {
                    region.skip_unless(region.wants(values[region.condition as usize].to_f64()), &mut index);
                    continue;
                }
            };
            for operand in run.each(op) {
                let [a, b, c] = [operand.a, operand.b, operand.c].map(|register| values[register as usize]);
                values[operand.d as usize] = match op {
                    Op::Copy => a,
                    Op::MulAdd => a * b + c,
                    Op::MulSub => a * b - c,
                    Op::NegMulAdd => c - a * b,
                    Op::Select if a.to_f64() <= 0.0 => c,
                    Op::Select => b,
                    Op::Unary(function) => unary(function, a),
                    Op::Binary(function) => binary(function, a, b),
                    Op::SinCos => {
                        let (sine, cosine) = sin_cos(a);
                        values[operand.b as usize] = cosine;
                        sine
                    }
                };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Graph, Input, lower};

    /// Differences of a tape's values give the derivative by another tape, to all its digits.
    #[test]
    fn differences_of_a_tape_are_derivatives() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (sine, root) = (g.sin(x), g.sqrt(y));
        let product = g.mul(sine, root);
        let value = g.div(product, x);
        let derivative = g.derivative(value, x);
        let inputs = [(x, 0), (y, 1)].map(|(symbol, register)| Input { symbol, stage: 0, register });
        let lowered = lower(&g, &inputs, 0, 2, &[vec![(value, None)], vec![(derivative, None)]]);
        let mut memory = DoubleDoubleMemory::new(lowered.registers, &lowered.constants);
        let (at, by) = (DoubleDouble::from(0.7), DoubleDouble::from(1e-10));
        memory.set(1, 3.0.into());
        let mut value = |x: DoubleDouble, kernel: usize| {
            memory.set(0, x);
            lowered.kernels.iter().for_each(|tape| memory.run(tape));
            memory.value(lowered.outputs[kernel][0] as usize)
        };
        let difference = (value(at + by, 0) - value(at - by, 0)) / (by + by);
        let derivative = value(at, 1);
        assert!(((difference - derivative) / derivative).to_f64().abs() < 1e-18);
    }
}
