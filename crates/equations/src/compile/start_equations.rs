//! The equations that hold at the start — constraints, their rates, and the conditions of the start alone — and the
//! meaning of their rows.

use symdiff::{Expr, Graph, SparseMatrix};

use super::equations::{
    ClosureRow, Equation, constraint_accelerations, constraint_rates, equations_of_motion, time_derivative,
};
use super::layout::Layout;
use super::sparse_lu::{NoFactors, Numbers};
use crate::assemble::{ConditionId, ConstraintId, CoordinateId, StartCondition, System};

/// Residual of a row of the closure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Residual {
    /// The row.
    pub row: ClosureRow,
    /// Its register.
    pub register: usize,
}

/// The equations that hold at the start.
pub(super) struct StartEquations {
    /// M w + Φ_qᵀ λ − Q, with Ψ_vᵀ λ.
    pub motion: Vec<Expr>,
    /// Φ_q, then Ψ_v.
    pub jacobian: SparseMatrix,
    /// Φ, then the conditions on positions.
    pub closure: Vec<Expr>,
    /// Its derivatives by q.
    pub closure_jacobian: SparseMatrix,
    /// Φ̇, Ψ, then the rates of the conditions on velocities.
    pub closure_rate: Vec<Expr>,
    /// Its derivatives by v.
    pub closure_rate_jacobian: SparseMatrix,
    /// Φ̇, then Ψ.
    pub rate: Vec<Expr>,
    /// Φ̈, then Ψ̇.
    pub rate_of_rate: Vec<Expr>,
}

/// The closure of positions or that of velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClosureOf {
    /// Φ and conditions on positions.
    Positions,
    /// Φ̇, Ψ and conditions on velocities.
    Velocities,
}

impl ClosureOf {
    /// Number of constraints in it.
    pub fn constraints(self, system: &System) -> usize {
        match self {
            Self::Positions => system.constraint.len(),
            Self::Velocities if system.start.fulfils_velocity_constraints => system.constraint.len(),
            Self::Velocities => system.lambda.len(),
        }
    }

    fn has(self, condition: &StartCondition) -> bool {
        match self {
            Self::Positions => condition.position,
            Self::Velocities => condition.velocity,
        }
    }
}

impl StartEquations {
    /// Equations over the system's own symbols.
    pub fn new(system: &System, graph: &mut Graph) -> Self {
        let (motion, jacobian) = equations_of_motion(system, graph);
        let rate = constraint_rates(system, graph);
        let rate_of_rate = constraint_accelerations(system, graph, &rate);
        let (further, closure_jacobian) = with_conditions(system, graph, &jacobian, ClosureOf::Positions);
        let closure = [&system.constraint[..], &further].concat();
        let (further, closure_rate_jacobian) = with_rates(system, graph, &jacobian);
        let closure_rate = [&rate[..ClosureOf::Velocities.constraints(system)], &further].concat();
        Self { motion, jacobian, closure, closure_jacobian, closure_rate, closure_rate_jacobian, rate, rate_of_rate }
    }
}

/// The constraints, then the conditions.
fn closure_rows(system: &System, of: ClosureOf) -> impl Iterator<Item = ClosureRow> {
    let conditions = system.start.conditions.iter().enumerate().filter(move |(_, condition)| of.has(condition));
    let constraints = (0..of.constraints(system)).map(ConstraintId::new).map(ClosureRow::Constraint);
    constraints.chain(conditions.map(|(index, _)| ClosureRow::Condition(ConditionId::new(index))))
}

/// Their residuals, in these registers.
pub(super) fn residuals(system: &System, of: ClosureOf, registers: Vec<usize>) -> Vec<Residual> {
    closure_rows(system, of).zip(registers).map(|(row, register)| Residual { row, register }).collect()
}

/// Positions and velocities that are given at the start, in the registers of the state.
pub(super) fn given_values(system: &System, layout: &Layout) -> Vec<(Expr, Option<u32>)> {
    let mut given = Vec::new();
    for (values, block) in [(&system.start.position, &layout.q), (&system.start.velocity, &layout.v)] {
        given.extend(
            values.iter().zip(block.clone()).filter_map(|(value, register)| value.map(|v| (v, Some(register as u32)))),
        );
    }
    given
}

/// A correction's matrix without factors: its rows are those of the coordinates, then those of the closure.
pub(super) fn named(system: &System, none: NoFactors, of: ClosureOf) -> NoFactors<Equation> {
    let closure = closure_rows(system, of).map(Equation::Closure);
    let motion = (0..system.q.len()).map(CoordinateId::new).map(Equation::Motion);
    let equations: Vec<Equation> = motion.chain(closure).collect();
    none.named(|row| equations[row])
}

/// The rates of the conditions on velocities, and Φ_q and Ψ_v with their derivatives by v below them.
fn with_rates(system: &System, graph: &mut Graph, jacobian: &SparseMatrix) -> (Vec<Expr>, SparseMatrix) {
    let (values, mut all) = with_conditions(system, graph, jacobian, ClosureOf::Velocities);
    let mut rates = time_derivative(system, graph, &values);
    let conditions = system.start.conditions.iter().filter(|condition| ClosureOf::Velocities.has(condition));
    for (index, condition) in conditions.enumerate() {
        if let Some(rate) = condition.rate {
            rates[index] = rate;
            let derivatives = graph.jacobian(&[rate], &system.v);
            let row = ClosureOf::Velocities.constraints(system) + index;
            all.rows.splice(row..=row, derivatives.rows);
        }
    }
    (rates, all)
}

/// The conditions of a closure, and its constraints' derivatives with theirs below them.
fn with_conditions(
    system: &System,
    graph: &mut Graph,
    jacobian: &SparseMatrix,
    of: ClosureOf,
) -> (Vec<Expr>, SparseMatrix) {
    let conditions = system.start.conditions.iter().filter(|condition| of.has(condition));
    let values: Vec<Expr> = conditions.map(|condition| condition.value).collect();
    let mut all = jacobian.clone();
    all.rows.truncate(of.constraints(system));
    all.rows.extend(graph.jacobian(&values, &system.q).rows);
    (values, all)
}

/// Σ Φ_ki² / metric_ii: each of m constraints' own entry in Φ_q metric⁻¹ Φ_qᵀ; 1 where nothing of it is left.
pub(super) fn constraint_sizes(matrix: &SparseMatrix, numbers: &[Numbers], diagonal: &[f64], m: usize) -> Vec<f64> {
    let n = diagonal.len();
    let mut sizes = vec![0.0; m];
    let entries = matrix.entries().zip(numbers).map(|((row, column, _), number)| (row, column, number[0]));
    entries.filter(|&(row, column, _)| row >= n && row < n + m && column < n).for_each(|(row, column, value)| {
        sizes[row - n] += value * value / diagonal[column];
    });
    sizes.into_iter().map(|size| if size > 0.0 { size } else { 1.0 }).collect()
}
