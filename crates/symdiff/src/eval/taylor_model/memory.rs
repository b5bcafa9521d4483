//! The evaluator over Taylor models: the same tapes, with a polynomial and its radius in every slot.

use crate::eval::interval::Interval;
use crate::eval::taylor_model::{ModelScratch, ModelSpace};
use crate::lower::tape::{Op, Tape, TapePart};

/// Memory of a program whose values are enclosed over a whole box of parameters.
#[derive(Clone, Debug)]
pub struct ModelMemory<'s> {
    space: &'s ModelSpace,
    scratch: ModelScratch,
    values: Vec<f64>,
    /// Results before they are stored: a result may replace an operand.
    first: Vec<f64>,
    second: Vec<f64>,
}

impl<'s> ModelMemory<'s> {
    /// Zeros, with `constants` set.
    pub fn new(space: &'s ModelSpace, registers: usize, constants: &[(u32, f64)]) -> Self {
        let size = space.size();
        let (first, second) = (vec![0.0; size], vec![0.0; size]);
        let mut memory =
            Self { space, scratch: ModelScratch::new(space), values: vec![0.0; registers * size], first, second };
        for &(register, value) in constants {
            space.constant(Interval::point(value), memory.model_mut(register as usize));
        }
        memory
    }

    /// The model in a slot.
    pub fn model(&self, register: usize) -> &[f64] {
        &self.values[register * self.space.size()..][..self.space.size()]
    }

    /// The model in a slot.
    pub fn model_mut(&mut self, register: usize) -> &mut [f64] {
        let size = self.space.size();
        &mut self.values[register * size..][..size]
    }

    /// Runs a tape.
    ///
    /// # Panics
    /// If the tape names a register that the memory does not have.
    pub fn run(&mut self, tape: &Tape) {
        let size = self.space.size();
        let Self { space, scratch, values, first, second } = self;
        let mut index = 0;
        while let Some(part) = tape.part(&mut index) {
            let (op, run) = match part {
                TapePart::Run(op, run) => (*op, run),
                TapePart::Region(region) => {
                    // A condition of unknown sign runs the region.
                    let sign = space.sign(&values[region.condition as usize * size..][..size]);
                    region.skip_unless(sign.is_none_or(|sign| region.wants(sign)), &mut index);
                    continue;
                }
            };
            for operand in run.each(op) {
                let model = |register: u32| &values[register as usize * size..][..size];
                let (a, b, c) = (model(operand.a), model(operand.b), model(operand.c));
                match op {
                    Op::Copy => first.copy_from_slice(a),
                    Op::MulAdd | Op::MulSub | Op::NegMulAdd => {
                        space.mul(a, b, second);
                        match op {
                            Op::MulAdd => space.add(second, c, first),
                            Op::MulSub => space.sub(second, c, first),
                            _ => space.sub(c, second, first),
                        }
                    }
                    Op::Select => match space.sign(a) {
                        Some(sign) => first.copy_from_slice(if sign <= 0.0 { c } else { b }),
                        None => space.unknown(first),
                    },
                    Op::Unary(function) => space.unary(function, a, first, scratch),
                    Op::Binary(function) => space.binary(function, a, b, first, scratch),
                    Op::SinCos => {
                        space.sin_cos(a, first, second, scratch);
                        values[operand.b as usize * size..][..size].copy_from_slice(second);
                    }
                }
                values[operand.d as usize * size..][..size].copy_from_slice(first);
            }
        }
    }
}
