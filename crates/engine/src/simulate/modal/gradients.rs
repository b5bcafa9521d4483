//! Derivatives of the outputs at a configuration.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph};

use crate::assemble::System;
use crate::compile::Layout;

/// Derivatives of the model's outputs by q, v, w and λ, as expressions.
#[derive(Clone, Debug)]
pub struct Gradients {
    graph: Graph,
    layout: Layout,
    /// Symbols in the expressions, with their registers in the layout.
    symbols: Vec<(Expr, usize)>,
    /// (output, column, value) by q, v, w and λ.
    entries: [Vec<(usize, usize, Expr)>; 4],
}

impl Gradients {
    /// Differentiates the first outputs of a system.
    pub fn new(system: &System, outputs: usize) -> Self {
        let mut graph = system.graph.clone();
        graph.limit(None);
        let of: Vec<Expr> = system.outputs[..outputs].iter().map(|output| output.expr).collect();
        let by = [&system.q, &system.v, &system.w, &system.lambda];
        let entries = by.map(|symbols| graph.jacobian(&of, symbols).entries().collect());
        let layout = Layout::of(system);
        let registers = [&layout.q, &layout.v, &layout.w, &layout.lambda];
        let mut symbols: Vec<(Expr, usize)> =
            by.into_iter().zip(registers).flat_map(|(s, r)| s.iter().copied().zip(r.clone())).collect();
        let parameters = system.parameters.iter().map(|parameter| parameter.symbol);
        symbols.extend(parameters.zip(layout.parameters.clone()));
        symbols.push((system.time, layout.time));
        Self { graph, layout, symbols, entries }
    }

    /// Rows by output, at a state (the layout's registers): by q, v and w per scale of the coordinates, and by λ.
    pub fn at(&self, state: &[f64], scale: &[f64], outputs: usize) -> [Vec<Vec<f64>>; 4] {
        let values: FxHashMap<Expr, f64> =
            self.symbols.iter().map(|&(symbol, register)| (symbol, state[register])).collect();
        let roots: Vec<Expr> = self.entries.iter().flatten().map(|&(_, _, value)| value).collect();
        let mut numbers =
            self.graph.evaluate(&roots, |symbol| values.get(&symbol).copied().unwrap_or(f64::NAN)).into_iter();
        let (n, m) = (self.layout.q.len(), self.layout.lambda.len());
        std::array::from_fn(|kind| {
            let mut rows = vec![vec![0.0; if kind < 3 { n } else { m }]; outputs];
            for (&(row, column, _), number) in self.entries[kind].iter().zip(numbers.by_ref()) {
                rows[row][column] = number * if kind < 3 { scale[column] } else { 1.0 };
            }
            rows
        })
    }
}
