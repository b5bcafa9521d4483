//! The equations that hold at the start: constraints, their rates, and the conditions of the start alone.

use symdiff::{Expr, Graph, SparseMatrix};

use super::equations::{equations_of_motion, time_derivative};
use super::sparse_lu::NoFactors;
use crate::assemble::{StartCondition, System};

/// The equations that hold at the start.
pub struct Equations {
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
pub const OF_POSITION: Kind = |condition| condition.position;
/// Conditions on velocities.
pub const OF_VELOCITY: Kind = |condition| condition.velocity;

impl Equations {
    /// Over the system's own symbols.
    pub fn new(system: &System, graph: &mut Graph) -> Self {
        let (motion, jacobian) = equations_of_motion(system, graph);
        let rate = time_derivative(system, graph, &system.constraint);
        let rate_of_rate = time_derivative(system, graph, &rate);
        let (further, closure_jacobian) = with_conditions(system, graph, &jacobian, OF_POSITION);
        let closure = [&system.constraint[..], &further].concat();
        let (further, closure_rate_jacobian) = with_conditions(system, graph, &jacobian, OF_VELOCITY);
        let closure_rate = [rate, time_derivative(system, graph, &further)].concat();
        Self { motion, jacobian, closure, closure_jacobian, closure_rate, closure_rate_jacobian, rate_of_rate }
    }
}

/// Conditions on positions, or those on velocities.
pub type Kind = fn(&StartCondition) -> bool;

/// Renumbers the rows of conditions of a kind, which follow the constraints, by their numbers among all conditions.
pub fn numbered(system: &System, none: NoFactors, kind: Kind) -> NoFactors {
    let NoFactors::Singular { rows } = none else { return none };
    let first = system.q.len() + system.constraint.len();
    let conditions: Vec<usize> =
        (0..system.start.conditions.len()).filter(|&place| kind(&system.start.conditions[place])).collect();
    let row = |row: usize| if row < first { row } else { first + conditions[row - first] };
    NoFactors::Singular { rows: rows.into_iter().map(row).collect() }
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
