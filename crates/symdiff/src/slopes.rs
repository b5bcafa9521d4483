//! Values of first derivatives, without their expressions.

use super::tuning::TUNING;
use crate::eval::jet::{JetMemory, JetSpace};
use crate::expr::{Expr, Graph};
use crate::lower::{Input, lower};

/// ∂of/∂by, with the symbols' values by `value_of`: a row for each of `of`. A derivative takes a few operations for
/// each expression, whereas its own expression would have to be written down.
pub fn slopes(graph: &Graph, of: &[Expr], by: &[Expr], value_of: impl Fn(Expr) -> f64) -> Vec<Vec<f64>> {
    let symbols = graph.symbols_of(of);
    let inputs: Vec<Input> =
        symbols.iter().zip(0..).map(|(&symbol, register)| Input { symbol, stage: 0, register }).collect();
    let outputs = of.iter().map(|&value| (value, None)).collect();
    let lowered = lower(graph, &inputs, 0, symbols.len() as u32, &[outputs]);
    let mut rows = vec![Vec::with_capacity(by.len()); of.len()];
    for block in by.chunks(TUNING.slopes_at_once) {
        let space = JetSpace::new(block.len(), 1);
        let mut memory = JetMemory::new(&space, lowered.registers, &lowered.constants);
        for (register, &symbol) in symbols.iter().enumerate() {
            match block.iter().position(|&other| other == symbol) {
                Some(index) => space.variable(index, value_of(symbol), 1.0, memory.jet_mut(register)),
                None => memory.set_constant(register, value_of(symbol)),
            }
        }
        memory.run(&lowered.kernels[0]);
        for (row, &register) in rows.iter_mut().zip(&lowered.outputs[0]) {
            row.extend_from_slice(&memory.jet(register as usize)[1..]);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_match_symbolic_derivatives() {
        let mut g = Graph::new();
        let symbols: Vec<Expr> = (0..40).map(|index| g.symbol(&format!("x{index}"))).collect();
        let mut of = Vec::new();
        for pair in symbols.windows(2) {
            let sine = g.sin(pair[0]);
            let product = g.mul(sine, pair[1]);
            let before = of.last().copied().unwrap_or(product);
            of.push(g.add(before, product));
        }
        of.push(symbols[3]);
        of.push(g.constant(2.0));
        let value = |symbol: Expr| 0.1 + symbols.iter().position(|&other| other == symbol).unwrap() as f64 / 7.0;
        let found = slopes(&g, &of, &symbols, value);
        let jacobian = g.jacobian(&of, &symbols);
        let mut wanted = vec![vec![0.0; symbols.len()]; of.len()];
        for (row, column, entry) in jacobian.entries() {
            wanted[row][column] = g.evaluate(&[entry], value)[0];
        }
        for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-15, "{found} {wanted}");
        }
    }
}
