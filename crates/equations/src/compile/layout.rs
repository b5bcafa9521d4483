//! The layout of a program's memory.

use std::ops::Range;

use symdiff::{Expr, Input, Tile};

use crate::assemble::System;

/// The registers that integration reads and writes; a program's own values stand above them. All programs of a system
/// share this part, so that a state can be copied from one to another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Uncertain parameters, k.
    pub parameters: Range<usize>,
    /// Levels and slopes of excitations that are functions, two each, or values of random ones, three each.
    pub inputs: Range<usize>,
    /// Step size h, s.
    pub step: usize,
    /// Time that the state belongs to; t₊ while a step is solved, s.
    pub time: usize,
    /// Positions, n.
    pub q: Range<usize>,
    /// Velocities, n.
    pub v: Range<usize>,
    /// Algorithmic accelerations a, n.
    pub a: Range<usize>,
    /// True accelerations w = v̇, n.
    pub w: Range<usize>,
    /// Lagrange multipliers, m; Newton's iterate while a step is solved.
    pub lambda: Range<usize>,
    /// Newton's iterate of w₊, n.
    pub iterate: Range<usize>,
    /// Newton's correction of (w₊, λ₊), n + m.
    pub correction: Range<usize>,
}

impl Layout {
    /// Returns the layout of a system.
    pub fn of(system: &System) -> Self {
        let (n, m) = (system.q.len(), system.lambda.len());
        let mut next = 0;
        let mut block = |length: usize| {
            next += length;
            next - length..next
        };
        Self {
            parameters: block(system.parameters.len()),
            inputs: block(system.input_symbols().count()),
            step: block(1).start,
            time: block(1).start,
            q: block(n),
            v: block(n),
            a: block(n),
            w: block(n),
            lambda: block(m),
            iterate: block(n),
            correction: block(n + m),
        }
    }

    /// Number of registers of this part.
    pub fn registers(&self) -> usize {
        self.correction.end
    }

    /// The registers that make up a state: q, v, a, w, λ.
    pub fn state(&self) -> Range<usize> {
        self.q.start..self.lambda.end
    }

    /// Sets levels and slopes of excitations that are functions, lane by lane.
    pub fn set_inputs(&self, tile: &mut Tile, values: &[f64]) {
        tile.block_mut(self.inputs.clone()).copy_from_slice(values);
    }

    /// The system's symbols as inputs: parameters at stage 0, everything else at stage 1.
    pub(super) fn inputs(&self, system: &System) -> Vec<Input> {
        let mut inputs = Vec::new();
        let mut add = |symbols: &[Expr], start: usize, stage: usize| {
            inputs.extend(symbols.iter().zip(start..).map(|(&symbol, register)| Input {
                symbol,
                stage,
                register: register as u32,
            }));
        };
        let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
        add(&parameters, self.parameters.start, 0);
        let of_inputs: Vec<Expr> = system.input_symbols().collect();
        add(&of_inputs, self.inputs.start, 1);
        add(&[system.time], self.time, 1);
        add(&system.q, self.q.start, 1);
        add(&system.v, self.v.start, 1);
        add(&system.w, self.w.start, 1);
        add(&system.lambda, self.lambda.start, 1);
        inputs
    }
}
