//! Reactions that equilibrium does not determine.
//!
//! Where constraints are redundant, Φ_qᵀ λ does not change along null vectors of Φ_qᵀ: reactions may be shifted along
//! them, and only elasticity, which rigid bodies do not have, would determine the shift. The multipliers of the
//! constraints that are reported as redundant are set to zero. The motion does not depend on that choice.

use nalgebra::{DMatrix, SymmetricEigen};
use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::tuning::TUNING;
use crate::assemble::{OutputId, System};
use crate::compile::{Layout, StartProgram};
use crate::simulate::motion_values::motion_values;
use crate::simulate::start::{Mobility, jacobian_rows, move_apart, spread};

/// Outputs that change when reactions are shifted along null vectors of Φ_qᵀ, at a state in general position.
pub fn undetermined_outputs(
    system: &System,
    start: &StartProgram,
    nominal: &[f64],
    mobility: &Mobility,
) -> Vec<OutputId> {
    if mobility.redundant.is_empty() {
        return Vec::new();
    }
    let state = move_apart(system, nominal).unwrap_or_else(|| nominal.to_vec());
    let shifts = null_vectors(system, start, &state, mobility.redundant.len());
    let values = general_values(system, &start.layout, &state);
    let mut graph = system.graph.clone();
    let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
    let derivatives = graph.jacobian(&outputs, &system.lambda);
    let (places, entries): (Vec<_>, Vec<_>) =
        derivatives.entries().map(|(output, constraint, derivative)| ((output, constraint), derivative)).unzip();
    let numbers = graph.evaluate(&entries, |symbol| values.get(&symbol).copied().unwrap_or(0.0));
    let mut gradient = DMatrix::zeros(outputs.len(), system.lambda.len());
    places.into_iter().zip(numbers).for_each(|(index, number)| gradient[index] = number);
    let along = &gradient * shifts;
    let depends =
        |output: &usize| along.row(*output).norm() > TUNING.negligible_derivative * gradient.row(*output).norm();
    (0..outputs.len()).filter(depends).map(OutputId::new).collect()
}

/// `count` left null vectors of Φ_q, one a column.
fn null_vectors(system: &System, start: &StartProgram, state: &[f64], count: usize) -> DMatrix<f64> {
    let mut jacobian: DMatrix<f64> = DMatrix::zeros(system.lambda.len(), system.q.len());
    for (row, entries) in jacobian_rows(system, start, state).into_iter().enumerate() {
        entries.into_iter().for_each(|(column, value)| jacobian[(row, column)] += value);
    }
    let products: DMatrix<f64> = &jacobian * jacobian.transpose();
    let modes = SymmetricEigen::new(products);
    let mut order: Vec<usize> = (0..system.lambda.len()).collect();
    order.sort_by(|&a, &b| f64::total_cmp(&modes.eigenvalues[a], &modes.eigenvalues[b]));
    modes.eigenvectors.select_columns(&order[..count])
}

/// The state's positions, and velocities, accelerations and multipliers in general position.
fn general_values(system: &System, layout: &Layout, state: &[f64]) -> FxHashMap<Expr, f64> {
    let mut values = motion_values(system, layout, state, 0.0);
    let free = [&system.v, &system.w, &system.lambda];
    let free = free.into_iter().flatten().copied().enumerate();
    values.extend(free.map(|(index, symbol)| (symbol, 1.0 + spread(3, index))));
    values
}
