//! The equations of motion and the constraints' rates, as expressions over the system's own symbols.

use symdiff::{Expr, Graph, SparseMatrix};

use crate::assemble::{ConditionId, ConstraintId, CoordinateId, System};

/// A row of the closure: an equation that positions have to fulfil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosureRow {
    /// A constraint.
    Constraint(ConstraintId),
    /// A condition of the start.
    Condition(ConditionId),
}

/// An equation of a start or of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equation {
    /// An equation of motion, by its coordinate.
    Motion(CoordinateId),
    /// A row of the closure.
    Closure(ClosureRow),
}

impl Equation {
    /// Returns the equation of a row of a system of n coordinates: the equations of motion, then the constraints.
    pub fn of_row(row: usize, n: usize) -> Self {
        match row.checked_sub(n) {
            None => Self::Motion(CoordinateId::new(row)),
            Some(constraint) => Self::Closure(ClosureRow::Constraint(ConstraintId::new(constraint))),
        }
    }
}

/// M w + Φ_qᵀ λ − Q, n rows, and Φ_q with Ψ_v below it, over the system's symbols. No constraint pushes on states, and
/// states are given where velocities are made to fulfil Ψ: Ψ_v has no columns of theirs
/// (`velocity_constraints_by_states`).
pub fn equations_of_motion(system: &System, graph: &mut Graph) -> (Vec<Expr>, SparseMatrix) {
    let n = system.q.len();
    // Conditional forces come last: without them the rows are those of a system that has none.
    let force = match system.active_condition {
        Some(condition) => graph.assume(&system.force, condition, false),
        None => system.force.clone(),
    };
    let mut rows: Vec<Expr> = force.into_iter().map(|force| graph.neg(force)).collect();
    debug_assert_eq!(rows.len(), n);
    let jacobian = constraint_jacobian(system, graph);
    for (constraint, coordinate, derivative) in jacobian.entries() {
        let force = graph.mul(derivative, system.lambda[constraint]);
        rows[coordinate] = graph.add(rows[coordinate], force);
    }
    for (row, &inertia) in rows.iter_mut().zip(&system.inertia) {
        *row = graph.add(*row, inertia);
    }
    if let Some(condition) = system.active_condition {
        for (row, &part) in rows.iter_mut().zip(&system.conditional) {
            let all = graph.sub(*row, part);
            *row = graph.select(condition, all, *row);
        }
    }
    (rows, jacobian)
}

/// Φ_q, and Ψ_v below it: m rows.
fn constraint_jacobian(system: &System, graph: &mut Graph) -> SparseMatrix {
    let mut jacobian = graph.jacobian(&system.constraint, &system.q);
    jacobian.rows.extend(velocity_constraints_by(system, graph, false).rows);
    jacobian
}

/// Ψ_y, a row for each Ψ, by the coordinates of the states.
pub fn velocity_constraints_by_states(system: &System, graph: &mut Graph) -> SparseMatrix {
    velocity_constraints_by(system, graph, true)
}

/// Ψ's derivatives by states, or by the velocities of the mechanism.
fn velocity_constraints_by(system: &System, graph: &mut Graph, states: bool) -> SparseMatrix {
    let mut derivatives = graph.jacobian(&system.velocity_constraint, &system.v);
    let is_kept = |column: usize| system.coordinates[column].is_state == states;
    derivatives.rows.iter_mut().for_each(|row| row.retain(|&(column, _)| is_kept(column)));
    derivatives
}

/// Φ̇, and Ψ below it: m rows.
pub fn constraint_rates(system: &System, graph: &mut Graph) -> Vec<Expr> {
    let mut rates = time_derivative(system, graph, &system.constraint);
    rates.extend(&system.velocity_constraint);
    rates
}

/// Φ̈, and Ψ̇ below it, of [`constraint_rates`]: m rows, in which states change by their rates.
pub fn constraint_accelerations(system: &System, graph: &mut Graph, rates: &[Expr]) -> Vec<Expr> {
    let coordinates = system.coordinates.iter().zip(system.w.iter().zip(&system.force));
    let changes: Vec<Expr> =
        coordinates.map(|(coordinate, (&w, &rate))| if coordinate.is_state { rate } else { w }).collect();
    derivative_along(system, graph, rates, &changes)
}

/// d/dt of expressions of t, q and v, with q̇ = v and v̇ = w.
pub fn time_derivative(system: &System, graph: &mut Graph, of: &[Expr]) -> Vec<Expr> {
    derivative_along(system, graph, of, &system.w)
}

/// d/dt of expressions of t, q and v, with q̇ = v and these v̇.
fn derivative_along(system: &System, graph: &mut Graph, of: &[Expr], accelerations: &[Expr]) -> Vec<Expr> {
    let along = [(&system.q, &system.v[..]), (&system.v, accelerations)];
    let mut rates: Vec<Expr> = of.iter().map(|&value| graph.derivative(value, system.time)).collect();
    for (coordinates, speeds) in along {
        for (row, column, derivative) in graph.jacobian(of, coordinates).entries() {
            let change = graph.mul(derivative, speeds[column]);
            rates[row] = graph.add(rates[row], change);
        }
    }
    rates
}
