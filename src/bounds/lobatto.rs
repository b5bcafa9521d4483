//! Nested Chebyshev–Lobatto nodes, and interpolation on them level by level.
//!
//! Level 0 is the middle alone, level l ≥ 1 has the N + 1 nodes cos(πj/N), N = 2^l, and each level has those before it.
//! Nodes are *numbered* in the order in which levels bring them, the middle first: numbers 0…N are level l, and serve as
//! degrees too, since the polynomials on level l are those up to degree N.
//!
//! Values become coefficients in two steps, each triangular in levels: a new node's *surplus* is its value less what the level
//! before predicts there; and f = Σ surplus · (cardinal polynomial of the node on its own level).

use super::tensor::{Matrix, cos_pi};

/// Highest level: degree 128, so that a degree fits a byte.
pub(super) const MAX_LEVEL: u8 = 7;

/// Highest degree of a level, N: one less than its nodes.
pub(super) fn degree(level: u8) -> usize {
    if level == 0 { 0 } else { 1 << level }
}

/// Numbers of the nodes that a level adds to those before it.
pub(super) fn fresh(level: u8) -> std::ops::RangeInclusive<u8> {
    let first = if level == 0 { 0 } else { degree(level - 1) + 1 };
    first as u8..=degree(level) as u8
}

/// The level that brings a node.
fn level(number: usize) -> u8 {
    (0..=MAX_LEVEL).find(|&level| number <= degree(level)).expect("numbers go up to the highest level")
}

/// The node of a number.
pub(super) fn node(number: u8) -> f64 {
    let own = level(number.into());
    if own == 0 { 0.0 } else { cos_pi(place(number.into(), own), degree(own)) }
}

/// j of a node as cos(πj/N) on a level that has it.
fn place(number: usize, on: u8) -> usize {
    let own = level(number);
    let (place, intervals) = match own {
        0 => (1, 2),
        1 => (if number == 1 { 0 } else { 2 }, 2),
        _ => (2 * (number - degree(own - 1)) - 1, degree(own)),
    };
    place * degree(on) / intervals
}

/// Coefficient of C_j in the cardinal polynomial of a node on a level: 1 there, 0 at the level's other nodes.
fn cardinal(j: usize, number: usize, on: u8) -> f64 {
    let n = degree(on);
    if n == 0 {
        return 1.0;
    }
    let place = place(number, on);
    let halved = |at_end: bool| if at_end { 0.5 } else { 1.0 };
    2.0 / n as f64 * halved(j == 0 || j == n) * halved(place == 0 || place == n) * cos_pi(j * place, n)
}

/// One level's part of both steps.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// What earlier nodes' values (columns) predict at this level's new nodes (rows).
    pub prediction: Matrix,
    /// Coefficients (rows, degrees 0…N) of the new nodes' cardinal polynomials (columns).
    pub cardinals: Matrix,
}

impl Level {
    pub fn new(level: u8) -> Self {
        let first = usize::from(*fresh(level).start());
        let n = degree(level);
        let predicted = |new: usize, old: usize| -> f64 {
            let at = place(first + new, level);
            (0..first).map(|j| cardinal(j, old, level - 1) * cos_pi(j * at, n)).sum()
        };
        Self {
            prediction: Matrix::new(n + 1 - first, first, predicted),
            cardinals: Matrix::new(n + 1, n + 1 - first, |j, new| cardinal(j, first + new, level)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chebyshev::clenshaw;
    use super::*;

    #[test]
    fn levels_are_nested_and_are_the_extrema_of_their_highest_degree() {
        for level in 0..=MAX_LEVEL {
            let n = degree(level);
            let mut nodes: Vec<f64> = (0..=n).map(|number| node(number as u8)).collect();
            nodes.sort_by(|a, b| b.total_cmp(a));
            let expected: Vec<f64> = if n == 0 { vec![0.0] } else { (0..=n).map(|j| cos_pi(j, n)).collect() };
            assert_eq!(nodes, expected);
        }
        let fresh: Vec<usize> = (0..=MAX_LEVEL).map(|level| fresh(level).count()).collect();
        assert_eq!(fresh, [1, 2, 2, 4, 8, 16, 32, 64]);
    }

    #[test]
    fn cardinal_polynomials_are_one_at_their_node_and_zero_at_the_others() {
        for on in 0..=5 {
            for number in 0..=degree(on) {
                let c: Vec<f64> = (0..=degree(on)).map(|j| cardinal(j, number, on)).collect();
                for other in 0..=degree(on) {
                    let value = if c.len() == 1 { c[0] } else { clenshaw(&c, node(other as u8)) };
                    assert!((value - f64::from(u8::from(other == number))).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn a_level_predicts_what_it_has_the_degree_for() {
        for level in 1..=5 {
            let parts = Level::new(level);
            let n = degree(level - 1);
            let f = |number: usize| node(number as u8).powi(n as i32);
            for (row, number) in parts.prediction.entries.chunks_exact(n + 1).zip(n + 1..) {
                let predicted: f64 = row.iter().enumerate().map(|(old, weight)| weight * f(old)).sum();
                assert!((predicted - f(number)).abs() < 1e-13);
            }
        }
    }
}
