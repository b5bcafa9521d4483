//! The start nearest to rest, where the model leaves it open: the least squares that replace the smallest change.
//!
//! ```text
//! ½ Σ (Ψ_k/s_k)² → min, Φ = 0        [ η D + Σ ∇Ψ_k ∇Ψ_kᵀ/s_k²   Φ_qᵀ ] [δq]     [ Σ Ψ_k ∇Ψ_k/s_k² ]
//!                                    [ Φ_q                       −ε   ] [μ ] = − [ Φ                ]
//! ```
//!
//! Ψ are the distances ([`crate::assemble::Distance`]), for velocities Ψ̇. η D only keeps each correction small along
//! directions that no distance depends on: it is no part of the right side, so the solution does not depend on it.

use symdiff::{Expr, Graph};

use super::equations::time_derivative;
use crate::assemble::{Distance, System};
use crate::compile::tuning::TUNING;

/// Parts of the start that given values and constraints leave open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpenStart {
    /// Positions.
    pub positions: bool,
    /// Velocities that differ from zero.
    pub velocities: bool,
}

impl OpenStart {
    /// Whether anything is open.
    pub fn is_any(self) -> bool {
        self.positions || self.velocities
    }
}

/// The metric (row, column, value) of corrections, n × n, and the gradient, n.
pub struct LeastSquares {
    pub metric: Vec<(usize, usize, Expr)>,
    pub gradient: Vec<Expr>,
    /// Whether the metric couples coordinates of different bodies.
    pub is_coupled: bool,
}

impl LeastSquares {
    /// The smallest change: D.
    pub fn smallest_change(system: &System, graph: &mut Graph) -> Self {
        Self {
            metric: diagonal(system, graph, 1.0),
            gradient: vec![graph.constant(0.0); system.q.len()],
            is_coupled: false,
        }
    }

    /// Positions nearest to rest.
    pub fn of_positions(system: &System, graph: &mut Graph) -> Self {
        let distances = distances(system, |distance| distance.position);
        let values: Vec<Expr> = distances.iter().map(|distance| distance.value).collect();
        Self::of(system, graph, &distances, &values)
    }

    /// Velocities nearest to rest.
    pub fn of_velocities(system: &System, graph: &mut Graph) -> Self {
        let distances = distances(system, |distance| distance.velocity);
        let positions: Vec<Expr> = distances.iter().map(|distance| distance.value).collect();
        let values = time_derivative(system, graph, &positions);
        Self::of(system, graph, &distances, &values)
    }

    /// `values` are the distances, or their rates: the derivatives of both, by q and by v, are those of the distances
    /// by q.
    fn of(system: &System, graph: &mut Graph, distances: &[&Distance], values: &[Expr]) -> Self {
        let mut metric = diagonal(system, graph, TUNING.proximity);
        let mut gradient = vec![graph.constant(0.0); system.q.len()];
        let positions: Vec<Expr> = distances.iter().map(|distance| distance.value).collect();
        let slopes = graph.jacobian(&positions, &system.q);
        for ((slopes, &value), distance) in slopes.rows.iter().zip(values).zip(distances) {
            let weight = distance.scale.powi(-2);
            for &(row, slope) in slopes {
                let weighted = graph.scale(weight, slope);
                let part = graph.mul(weighted, value);
                gradient[row] = graph.add(gradient[row], part);
                metric.extend(slopes.iter().map(|&(column, other)| (row, column, graph.mul(weighted, other))));
            }
        }
        Self { metric, gradient, is_coupled: true }
    }
}

/// Distances of the start that are open in a way.
fn distances(system: &System, is_open: fn(&Distance) -> bool) -> Vec<&Distance> {
    let nearest = system.start.nearest.iter();
    nearest.flat_map(|nearest| &nearest.distances).filter(|distance| is_open(distance)).collect()
}

/// `share` · D.
fn diagonal(system: &System, graph: &mut Graph, share: f64) -> Vec<(usize, usize, Expr)> {
    let weights = system.coordinates.iter().map(|coordinate| share * coordinate.scale.powi(-2));
    weights.enumerate().map(|(index, weight)| (index, index, graph.constant(weight))).collect()
}
