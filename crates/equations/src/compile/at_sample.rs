//! Numbers of expressions at a sample, by which eliminations are planned.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Input, slopes};

use crate::assemble::System;

/// A state, by symbol.
#[derive(Clone, Debug)]
pub(super) struct AtSample<'s> {
    register_of: FxHashMap<Expr, usize>,
    /// Values of registers.
    sample: &'s [f64],
}

impl<'s> AtSample<'s> {
    /// Values by the symbols of these inputs, whose registers have the values of the sample.
    pub fn new(inputs: &[Input], sample: &'s [f64]) -> Self {
        Self { register_of: inputs.iter().map(|input| (input.symbol, input.register as usize)).collect(), sample }
    }

    /// Values of expressions.
    pub fn values(&self, graph: &Graph, exprs: &[Expr]) -> Vec<f64> {
        graph.evaluate(exprs, |symbol| self.sample[self.register_of[&symbol]])
    }

    /// The diagonal of M. If M is omitted, it follows from the inertial forces, which are linear in w.
    pub fn masses(&self, system: &System) -> Vec<f64> {
        if system.is_mass_left_out() {
            return self.masses_of_long_trees(system);
        }
        let diagonal: Vec<&(usize, usize, Expr)> =
            system.mass.iter().filter(|(row, column, _)| row == column).collect();
        let entries: Vec<Expr> = diagonal.iter().map(|(_, _, value)| *value).collect();
        let mut masses = vec![0.0; system.q.len()];
        for ((row, ..), value) in diagonal.into_iter().zip(self.values(&system.graph, &entries)) {
            masses[*row] = value;
        }
        masses
    }

    fn masses_of_long_trees(&self, system: &System) -> Vec<f64> {
        let value = |symbol: Expr| self.sample[self.register_of[&symbol]];
        let rows = slopes(&system.graph, &system.inertia, &system.w, value);
        rows.into_iter().enumerate().map(|(row, entries)| entries[row]).collect()
    }
}
