//! Derivatives of formulas of parameters: those of their expressions.

use symdiff::Expr;

use crate::assemble::System;
use crate::numerics::Sample;

/// Outputs of a system without a mechanism, with their derivatives by all parameters; by number of sample and output.
pub(super) fn derivatives_of_formulas(
    system: &System,
    samples: &[Sample],
    wanted: impl Iterator<Item = (usize, usize)>,
) -> Vec<(f64, Vec<f64>)> {
    let mut graph = system.graph.clone();
    let symbols: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
    let jacobian = graph.jacobian(&outputs, &symbols);
    let of = |(sample, output): (usize, usize)| {
        let entries: Vec<(usize, Expr)> =
            jacobian.entries().filter(|&(row, ..)| row == output).map(|(_, column, of)| (column, of)).collect();
        let roots: Vec<Expr> = entries.iter().map(|&(_, of)| of).chain([outputs[output]]).collect();
        let sample = &samples[sample];
        let value_of = |symbol| symbols.iter().position(|own| *own == symbol).map_or(0.0, |index| sample[index]);
        let values = graph.evaluate(&roots, value_of);
        let mut by_parameters = vec![0.0; symbols.len()];
        entries.iter().zip(&values).for_each(|(&(column, _), value)| by_parameters[column] = *value);
        (values[entries.len()], by_parameters)
    };
    wanted.map(of).collect()
}
