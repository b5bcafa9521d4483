//! Derivatives of formulas of parameters: those of their expressions.

use symdiff::Expr;

use super::tiles::{Gradient, Wanted};
use crate::assemble::System;
use crate::numerics::Sample;

/// Outputs of a system without a mechanism, with their derivatives by all parameters.
pub(super) fn gradients_of_formulas(system: &System, samples: &[Sample], wanted: &[Wanted]) -> Vec<Gradient> {
    let mut graph = system.graph.clone();
    let symbols: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
    let jacobian = graph.jacobian(&outputs, &symbols);
    let of = |wanted: &Wanted| {
        let entries: Vec<(usize, Expr)> =
            jacobian.entries().filter(|&(row, ..)| row == wanted.output).map(|(_, column, of)| (column, of)).collect();
        let roots: Vec<Expr> = entries.iter().map(|&(_, of)| of).chain([outputs[wanted.output]]).collect();
        let sample = &samples[wanted.sample];
        let value_of = |symbol| symbols.iter().position(|own| *own == symbol).map_or(0.0, |index| sample[index]);
        let values = graph.evaluate(&roots, value_of);
        let mut by_parameters = vec![0.0; symbols.len()];
        entries.iter().zip(&values).for_each(|(&(column, _), value)| by_parameters[column] = *value);
        Gradient { value: values[entries.len()], by_parameters, lost: None }
    };
    wanted.iter().map(of).collect()
}
