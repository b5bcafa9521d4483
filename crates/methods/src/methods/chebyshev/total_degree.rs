//! Orders that are given for more parameters than a full grid can have: a sparse grid, whose terms have degrees that,
//! each as a share of its order, add up to one at most.

use super::tuning::TUNING;
use crate::numerics::{SparseGrid, Surrogate};

fn full(nodes: &[usize]) -> f64 {
    nodes.iter().map(|&count| count as f64).product()
}

/// The sparse grid, where the full one has too many nodes and this one has not.
fn sparse(order: &[usize], nodes: &[usize]) -> Option<SparseGrid> {
    if full(nodes) > TUNING.most_nodes_of_full as f64 {
        SparseGrid::simplex(order, TUNING.most_nodes_of_full)
    } else {
        None
    }
}

/// Number of samples of the surrogate of a given order.
pub(super) fn samples(order: &[usize], nodes: &[usize]) -> f64 {
    sparse(order, nodes).map_or_else(|| full(nodes), |grid| grid.len() as f64)
}

/// The surrogate of a given order, and whether its grid is full.
pub(super) fn surrogate(order: &[usize], nodes: &[usize]) -> (Surrogate, bool) {
    match sparse(order, nodes) {
        Some(grid) => (Surrogate::sparse(&grid), false),
        None => (Surrogate::tensor(order, nodes), true),
    }
}
