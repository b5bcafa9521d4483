//! The equations of motion and the constraints' rates, as expressions over the system's own symbols.

use symdiff::{Expr, Graph, SparseMatrix};

use crate::mechanics::System;

/// M w + Φ_qᵀ λ − Q, n rows, and Φ_q, over the system's symbols.
pub fn equations_of_motion(system: &System, graph: &mut Graph) -> (Vec<Expr>, SparseMatrix) {
    let n = system.q.len();
    let mut rows: Vec<Expr> = system.force.iter().map(|&force| graph.neg(force)).collect();
    debug_assert_eq!(rows.len(), n);
    let slopes = graph.jacobian(&system.constraint, &system.q);
    for (constraint, coordinate, slope) in slopes.entries() {
        let pull = graph.mul(slope, system.lambda[constraint]);
        rows[coordinate] = graph.add(rows[coordinate], pull);
    }
    for (row, &inertia) in rows.iter_mut().zip(&system.inertia) {
        *row = graph.add(*row, inertia);
    }
    (rows, slopes)
}

/// d/dt of expressions of t, q and v, along v and w.
pub fn time_derivative(system: &System, graph: &mut Graph, of: &[Expr]) -> Vec<Expr> {
    let along = [(&system.q, &system.v), (&system.v, &system.w)];
    let mut rates: Vec<Expr> = of.iter().map(|&value| graph.derivative(value, system.time)).collect();
    for (coordinates, speeds) in along {
        for (row, column, slope) in graph.jacobian(of, coordinates).entries() {
            let change = graph.mul(slope, speeds[column]);
            rates[row] = graph.add(rates[row], change);
        }
    }
    rates
}
