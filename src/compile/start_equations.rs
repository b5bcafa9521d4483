//! The equations that hold at the start — constraints, their rates, and the conditions of the start alone — and what their rows are.

use symdiff::{Expr, Graph, SparseMatrix};

use super::equations::{ClosureRow, Equation, equations_of_motion, time_derivative};
use super::sparse_lu::{NoFactors, Numbers};
use crate::assemble::{ConditionId, ConstraintId, CoordinateId, StartCondition, System};

/// What remains of a row of the closure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Residual {
    /// Of which row.
    pub row: ClosureRow,
    /// Where it is.
    pub register: usize,
}

/// The equations that hold at the start.
pub(super) struct Equations {
    /// M w + Φ_qᵀ λ − Q.
    pub motion: Vec<Expr>,
    /// Φ_q.
    pub jacobian: SparseMatrix,
    /// Φ, then the conditions on positions.
    pub closure: Vec<Expr>,
    /// Its derivatives by q.
    pub closure_jacobian: SparseMatrix,
    /// Φ̇, then the rates of the conditions on velocities.
    pub closure_rate: Vec<Expr>,
    /// Its derivatives by v.
    pub closure_rate_jacobian: SparseMatrix,
    /// Φ̈.
    pub rate_of_rate: Vec<Expr>,
}

/// Conditions on positions.
pub(super) const OF_POSITION: Kind = |condition| condition.position;
/// Conditions on velocities.
pub(super) const OF_VELOCITY: Kind = |condition| condition.velocity;

impl Equations {
    /// Over the system's own symbols.
    pub fn new(system: &System, graph: &mut Graph) -> Self {
        let (motion, jacobian) = equations_of_motion(system, graph);
        let rate = time_derivative(system, graph, &system.constraint);
        let rate_of_rate = time_derivative(system, graph, &rate);
        let (further, closure_jacobian) = with_conditions(system, graph, &jacobian, OF_POSITION);
        let closure = [&system.constraint[..], &further].concat();
        let (further, closure_rate_jacobian) = with_rates(system, graph, &jacobian);
        let closure_rate = [rate, further].concat();
        Self { motion, jacobian, closure, closure_jacobian, closure_rate, closure_rate_jacobian, rate_of_rate }
    }
}

/// Conditions on positions, or those on velocities.
pub(super) type Kind = fn(&StartCondition) -> bool;

/// The constraints, then the conditions of a kind.
fn closure_rows(system: &System, kind: Kind) -> impl Iterator<Item = ClosureRow> {
    let conditions = system.start.conditions.iter().enumerate().filter(move |(_, condition)| kind(condition));
    let constraints = (0..system.constraint.len()).map(ConstraintId::new).map(ClosureRow::Constraint);
    constraints.chain(conditions.map(|(place, _)| ClosureRow::Condition(ConditionId::new(place))))
}

/// Their residuals, in these registers.
pub(super) fn residuals(system: &System, kind: Kind, registers: Vec<usize>) -> Vec<Residual> {
    closure_rows(system, kind).zip(registers).map(|(row, register)| Residual { row, register }).collect()
}

/// A correction's matrix without factors: its rows are those of the coordinates, then those of the closure.
pub(super) fn named(system: &System, none: NoFactors, kind: Kind) -> NoFactors<Equation> {
    let closure = closure_rows(system, kind).map(Equation::Closure);
    let motion = (0..system.q.len()).map(CoordinateId::new).map(Equation::Motion);
    let equations: Vec<Equation> = motion.chain(closure).collect();
    none.named(|row| equations[row])
}

/// The rates of the conditions on velocities, and Φ_q with their derivatives by v below it.
fn with_rates(system: &System, graph: &mut Graph, jacobian: &SparseMatrix) -> (Vec<Expr>, SparseMatrix) {
    let (values, mut all) = with_conditions(system, graph, jacobian, OF_VELOCITY);
    let mut rates = time_derivative(system, graph, &values);
    let conditions = system.start.conditions.iter().filter(|condition| OF_VELOCITY(condition));
    for (place, condition) in conditions.enumerate() {
        if let Some(rate) = condition.rate {
            rates[place] = rate;
            let derivatives = graph.jacobian(&[rate], &system.v);
            all.rows.splice(jacobian.rows.len() + place..=jacobian.rows.len() + place, derivatives.rows);
        }
    }
    (rates, all)
}

/// The conditions of a kind, and Φ_q with their derivatives below it.
fn with_conditions(
    system: &System,
    graph: &mut Graph,
    jacobian: &SparseMatrix,
    kind: Kind,
) -> (Vec<Expr>, SparseMatrix) {
    let conditions = system.start.conditions.iter().filter(|condition| kind(condition));
    let values: Vec<Expr> = conditions.map(|condition| condition.value).collect();
    let mut all = jacobian.clone();
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
