//! Sparse LU as expressions: the elimination order is chosen once, on numbers; the elimination itself becomes nodes of
//! the graph, and so instructions of the tapes, each evaluated at the stage at which it can change.
//!
//! - `active`: the submatrix not yet eliminated, and one step of the elimination on it;
//! - `ordering`: the order of blocks of coordinates (minimum degree);
//! - `pivoting`: the choice of the next pivot, by cost and size;
//! - `factor`: the elimination, pivot by pivot;
//! - `solve`: the factors, and the solution of a linear system with them.
//!
//! Order and pivots: Markowitz, *The elimination form of the inverse*, Management Science 3 (1957), with threshold
//! pivoting (Duff, Erisman & Reid, *Direct Methods for Sparse Matrices*, 2nd ed., ch. 7).

mod active;
mod factor;
mod ordering;
mod pivoting;
mod solve;

use super::tuning::TUNING;

pub use factor::{NoFactors, PivotRule, factorise};
pub use pivoting::Pivoting;
pub use solve::Factors;

/// An entry's value at each pivot sample.
pub type Numbers = [f64; TUNING.pivot_samples];

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use symdiff::{Expr, Graph, SparseMatrix, Stages};

    use super::*;

    fn solve_numbers(dense: &[Vec<f64>], right: &[f64]) -> Result<Vec<f64>, NoFactors> {
        solve_by(dense, right, Pivoting::Any).map(|(x, _)| x)
    }

    /// The solution, and the factors.
    fn solve_by(dense: &[Vec<f64>], right: &[f64], pivoting: Pivoting) -> Result<(Vec<f64>, Factors), NoFactors> {
        let mut graph = Graph::new();
        let mut matrix = SparseMatrix::zero(dense.len(), dense.len());
        let mut numbers = Vec::new();
        for (row, values) in dense.iter().enumerate() {
            for (column, &value) in values.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                let expr = graph.constant(value);
                matrix.rows[row].push((column, expr));
                numbers.push([value; TUNING.pivot_samples]);
            }
        }
        let scale = vec![1.0; dense.len()];
        let factors = factorise(
            &mut graph,
            &matrix,
            &numbers,
            &scale,
            &[],
            PivotRule { stages: Stages::new(&[]), costly: 0, pivoting },
        )?;
        let right: Vec<Expr> = right.iter().map(|&value| graph.constant(value)).collect();
        let x = factors.solve(&mut graph, &right);
        let x = x.into_iter().map(|expr| graph.as_constant(expr).unwrap()).collect();
        Ok((x, factors))
    }

    /// Three coordinates, the last massless and defined by the second constraint.
    #[test]
    fn massive_and_defining_entries_are_pivots() {
        let dense = [
            vec![2.0, 0.5, 0.0, 1.0, 0.3],
            vec![0.5, 3.0, 0.0, 0.7, -0.4],
            vec![0.0, 0.0, 0.0, 0.0, -1.0],
            vec![1.0, 0.7, 0.0, 0.0, 0.0],
            vec![0.3, -0.4, -1.0, 0.0, 0.0],
        ];
        let right = [1.0, 2.0, 3.0, 4.0, 5.0];
        let (x, factors) =
            solve_by(&dense, &right, Pivoting::Symmetric { massive: &[true, true, false], blocks: &[0, 1, 2] })
                .unwrap();
        for (row, b) in dense.iter().zip(right) {
            let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((product - b).abs() < 1e-13);
        }
        let pivots: Vec<(usize, usize)> = factors.pivots.iter().map(|pivot| (pivot.row, pivot.column)).collect();
        let index = pivots.iter().position(|&pivot| pivot == (2, 4)).unwrap();
        assert_eq!(pivots[index + 1], (4, 2), "{pivots:?}");
    }

    #[test]
    fn a_zero_diagonal_is_pivoted_around() {
        let x =
            solve_numbers(&[vec![0.0, 2.0, 0.0], vec![1.0, 0.0, 1.0], vec![0.0, 3.0, 1.0]], &[4.0, 3.0, 7.0]).unwrap();
        assert_eq!(x, [2.0, 2.0, 1.0]);
    }

    #[test]
    fn a_singular_matrix_names_the_rows_left() {
        let singular = solve_numbers(&[vec![1.0, 2.0], vec![2.0, 4.0]], &[1.0, 2.0]).unwrap_err();
        assert!(matches!(singular, NoFactors::Singular { rows } if rows.len() == 1));
    }

    proptest! {
        #[test]
        fn solutions_fulfil_their_equations(
            entries in prop::collection::vec(prop::option::weighted(0.4, -1.0..1.0_f64), 64),
            right in prop::collection::vec(-1.0..1.0_f64, 8),
        ) {
            let dense: Vec<Vec<f64>> = (0..8)
                .map(|row| (0..8).map(|column| entries[8 * row + column].unwrap_or(0.0) + if row == column { 3.0 } else { 0.0 }).collect())
                .collect();
            if let Ok(x) = solve_numbers(&dense, &right) {
                for (row, b) in dense.iter().zip(&right) {
                    let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
                    prop_assert!((product - b).abs() < 1e-9);
                }
            }
        }
    }
}
