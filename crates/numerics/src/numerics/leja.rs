//! Nested nodes, one more a degree, and interpolation on them level by level.
//!
//! Level l has the first l + 1 nodes of one sequence, and its polynomials those up to degree l. The sequence is Leja's
//! (each node where the product of the distances to those before is largest), taken from the extrema of Chebyshev
//! polynomials of degree 2, 4, 8, … one after the other, so that the first 3, 5, 9, 17, … nodes are
//! Chebyshev–Lobatto's. One node a degree, rather than as many as there were, keeps sets of many parameters small.
//!
//! Values become coefficients in two steps, each triangular in levels: a new node's *surplus* is its value less what
//! the level before predicts there; and f = Σ surplus · (polynomial of the node's level that is 1 there and 0 at the
//! nodes before).

use std::sync::OnceLock;

use super::tensor::{Matrix, cos_pi};
use super::tuning::TUNING;

/// The node that a level adds.
pub(super) fn node(level: u8) -> f64 {
    static NODES: OnceLock<Vec<f64>> = OnceLock::new();
    NODES.get_or_init(sequence)[usize::from(level)]
}

fn sequence() -> Vec<f64> {
    let mut nodes = vec![0.0, 1.0, -1.0];
    let mut intervals = 4;
    while nodes.len() <= usize::from(TUNING.max_level) {
        let mut new: Vec<f64> = (0..intervals / 2).map(|j| cos_pi(2 * j + 1, intervals)).collect();
        while !new.is_empty() {
            let spread = |x: &f64| nodes.iter().map(|node| (x - node).abs()).product::<f64>();
            // The first of equal values.
            let best =
                (1..new.len()).fold(0, |best, next| if spread(&new[next]) > spread(&new[best]) { next } else { best });
            nodes.push(new.remove(best));
        }
        intervals *= 2;
    }
    nodes
}

/// One level's part of both steps.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Weights of earlier nodes' values in the prediction at this level's node.
    pub prediction: Vec<f64>,
    /// Coefficients, degrees 0…l, of the polynomial that is 1 at this level's node and 0 at those before.
    pub cardinal: Vec<f64>,
}

impl Level {
    /// The level `level`, from 1 on, computed once.
    pub fn of(level: u8) -> &'static Self {
        static LEVELS: [OnceLock<Level>; TUNING.max_level as usize + 1] =
            [const { OnceLock::new() }; TUNING.max_level as usize + 1];
        LEVELS[usize::from(level)].get_or_init(|| Self::new(level))
    }

    fn new(level: u8) -> Self {
        let n = usize::from(level);
        let nodes: Vec<f64> = (0..=level).map(node).collect();
        let without = |skipped: usize, x: f64| -> f64 {
            (0..n).filter(|&i| i != skipped).map(|i| (x - nodes[i]) / (nodes[skipped] - nodes[i])).product()
        };
        let prediction = (0..n).map(|old| without(old, nodes[n])).collect();
        // By quadrature at the zeros of C_{n+1}, which is exact.
        let cosines = Matrix::new(n + 1, n + 1, |j, i| cos_pi(j * (2 * i + 1), 2 * (n + 1)));
        let values: Vec<f64> = (0..=n).map(|i| without(n, cos_pi(2 * i + 1, 2 * (n + 1)))).collect();
        let coefficient = |(j, row): (usize, &[f64])| {
            let sum: f64 = row.iter().zip(&values).map(|(cosine, value)| cosine * value).sum();
            sum * if j == 0 { 1.0 } else { 2.0 } / (n + 1) as f64
        };
        let cardinal = cosines.entries.chunks_exact(n + 1).enumerate().map(coefficient).collect();
        Self { prediction, cardinal }
    }
}

#[cfg(test)]
mod tests {
    use super::super::evaluation::clenshaw;
    use super::*;

    #[test]
    fn the_first_nodes_are_lobattos() {
        for n in [2, 4, 8, 16, 32, 64, 128] {
            let mut nodes: Vec<f64> = (0..=n).map(|level| node(level as u8)).collect();
            nodes.sort_by(|a, b| b.total_cmp(a));
            assert_eq!(nodes, (0..=n).map(|j| cos_pi(j, n)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn cardinal_polynomials_vanish_at_earlier_nodes() {
        for level in 1..=TUNING.max_level {
            let c = &Level::of(level).cardinal;
            for other in 0..=level {
                let value = clenshaw(c, node(other));
                assert!((value - f64::from(u8::from(other == level))).abs() < 1e-11, "{level}, {other}: {value}");
            }
        }
    }

    #[test]
    fn level_predicts_polynomials_of_lower_degree() {
        for level in 1..=24_u8 {
            let f = |level: u8, degree: i32| node(level).powi(degree);
            let prediction = &Level::of(level).prediction;
            let degree = i32::from(level) - 1;
            let predicted: f64 = prediction.iter().zip(0..).map(|(weight, old)| weight * f(old, degree)).sum();
            assert!((predicted - f(level, degree)).abs() < 1e-11, "{level}");
        }
    }
}
