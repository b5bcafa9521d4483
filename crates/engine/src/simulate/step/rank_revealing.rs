//! The rank-revealing solve: a linear system whose matrix may have lost rank, solved on its numbers alone, off the hot
//! path.

use std::collections::{BTreeMap, BTreeSet};

use super::tuning::TUNING;
use nalgebra::{DMatrix, DVector};

/// Solution of `matrix · x = right` where the matrix may have lost rank: entries (row, column, value), scaled
/// symmetrically by `scale`. Safe pivots are eliminated sparsely; the small remainder has its smallest least-squares
/// solution, by singular values. `None` where the numbers are not finite.
pub fn solve_rank_deficient(entries: &[(usize, usize, f64)], right: &[f64], scale: &[f64]) -> Option<Vec<f64>> {
    let finite = entries.iter().map(|(_, _, value)| value).chain(right).all(|value| value.is_finite());
    let mut left = Remainder::new(entries, right, scale);
    let mut pivots = Vec::new();
    while let Some(pivot) = left.eliminate() {
        pivots.push(pivot);
    }
    let mut x = left.smallest_solution().filter(|_| finite)?;
    for Eliminated { column, pivot, row, right } in pivots.iter().rev() {
        let known: f64 = row.iter().map(|&(other, value)| value * x[other]).sum();
        x[*column] = (right - known) / pivot;
    }
    x.iter_mut().zip(scale).for_each(|(x, scale)| *x *= scale);
    Some(x)
}

/// An eliminated row, which gives the unknown of its pivot's column.
struct Eliminated {
    column: usize,
    pivot: f64,
    row: Vec<(usize, f64)>,
    right: f64,
}

/// Rows and columns not yet eliminated.
struct Remainder {
    rows: Vec<BTreeMap<usize, f64>>,
    columns: Vec<BTreeSet<usize>>,
    right: Vec<f64>,
    /// (number of entries, row) of rows that may have a safe pivot.
    sparsest: BTreeSet<(usize, usize)>,
    largest: f64,
}

impl Remainder {
    fn new(entries: &[(usize, usize, f64)], right: &[f64], scale: &[f64]) -> Self {
        let mut rows = vec![BTreeMap::new(); right.len()];
        let mut columns = vec![BTreeSet::new(); right.len()];
        let mut largest = 0.0_f64;
        for &(row, column, value) in entries {
            let value = scale[row] * value * scale[column];
            largest = largest.max(value.abs());
            rows[row].insert(column, value);
            columns[column].insert(row);
        }
        let sparsest = rows.iter().enumerate().map(|(row, entries)| (entries.len(), row)).collect();
        let right = right.iter().zip(scale).map(|(value, scale)| value * scale).collect();
        Self { rows, columns, right, sparsest, largest }
    }

    /// Eliminates with the sparsest row that has a safe pivot, on the pivot whose column is sparsest.
    fn eliminate(&mut self) -> Option<Eliminated> {
        let (row, column) = loop {
            let (_, row) = self.sparsest.pop_first()?;
            let size = self.rows[row].values().fold(0.0, |size: f64, value| size.max(value.abs()));
            let smallest = (TUNING.safe_pivot.0 * self.largest).max(TUNING.safe_pivot.1 * size);
            let safe = self.rows[row].iter().filter(|(_, value)| value.abs() >= smallest);
            // A row without one waits until it changes.
            if let Some((&column, _)) = safe.min_by_key(|&(&column, _)| (self.columns[column].len(), column)) {
                break (row, column);
            }
        };
        let mut entries = std::mem::take(&mut self.rows[row]);
        entries.keys().for_each(|&column| {
            self.columns[column].remove(&row);
        });
        // The column was chosen among the entries of this row.
        let pivot = entries.remove(&column).expect("the pivot is one of the row's entries");
        for other in std::mem::take(&mut self.columns[column]) {
            self.sparsest.remove(&(self.rows[other].len(), other));
            // `columns` and `rows` gain and lose each entry together.
            let ratio = self.rows[other].remove(&column).expect("columns list the rows with an entry there") / pivot;
            for (&index, value) in &entries {
                *self.rows[other].entry(index).or_insert(0.0) -= ratio * value;
                self.columns[index].insert(other);
            }
            self.right[other] -= ratio * self.right[row];
            self.sparsest.insert((self.rows[other].len(), other));
        }
        Some(Eliminated { column, pivot, row: entries.into_iter().collect(), right: self.right[row] })
    }

    /// The solution of the remaining rows and columns by singular values; zero in the eliminated columns.
    fn smallest_solution(&self) -> Option<Vec<f64>> {
        let columns: BTreeSet<usize> = self.rows.iter().flat_map(|row| row.keys().copied()).collect();
        let columns: Vec<usize> = columns.into_iter().collect();
        let rows: Vec<usize> = (0..self.rows.len()).filter(|&row| !self.rows[row].is_empty()).collect();
        let mut x = vec![0.0; self.rows.len()];
        if rows.is_empty() {
            return Some(x);
        }
        let entry = |i: usize, j: usize| self.rows[rows[i]].get(&columns[j]).copied().unwrap_or(0.0);
        let matrix = DMatrix::from_fn(rows.len(), columns.len(), entry);
        let right = DVector::from_iterator(rows.len(), rows.iter().map(|&row| self.right[row]));
        if matrix.iter().chain(right.iter()).any(|value| !value.is_finite()) {
            return None;
        }
        let svd = matrix.try_svd(true, true, f64::EPSILON, 10_000)?;
        let solution =
            svd.solve(&right, TUNING.zero_singular_value * self.largest.max(svd.singular_values.max())).ok()?;
        columns.iter().zip(solution.iter()).for_each(|(&column, &value)| x[column] = value);
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_system_gives_its_smallest_solution() {
        let tiny = 1e-4;
        let entries = [(0, 0, tiny), (0, 1, tiny), (1, 0, tiny), (1, 1, tiny), (2, 2, 1.0)];
        let x = solve_rank_deficient(&entries, &[2.0 * tiny, 2.0 * tiny, 5.0], &[1.0; 3]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12 && x[2] == 5.0);
    }

    #[test]
    fn consistent_dependent_rows_are_solved() {
        let entries = [(0, 0, 1.0), (0, 1, 1.0), (1, 0, 1.0), (1, 2, -1.0), (2, 1, 1.0), (2, 2, 1.0)];
        let x = solve_rank_deficient(&entries, &[3.0, 1.0, 2.0], &[1.0; 3]).unwrap();
        for (row, right) in [3.0, 1.0, 2.0].into_iter().enumerate() {
            let sum: f64 = entries.iter().filter(|entry| entry.0 == row).map(|entry| entry.2 * x[entry.1]).sum();
            assert!((sum - right).abs() < 1e-14);
        }
    }

    #[test]
    fn regular_matrix_is_solved_exactly() {
        let entries: Vec<(usize, usize, f64)> = (0..6)
            .flat_map(|i| (0..6).map(move |j| (i, j, if i == j { 3.0 } else { 1.0 / (1.0 + (i + 2 * j) as f64) })))
            .collect();
        let right: Vec<f64> = (0..6).map(f64::from).collect();
        let x = solve_rank_deficient(&entries, &right, &[1.0, 0.5, 2.0, 1.0, 3.0, 0.1]).unwrap();
        for (row, right) in right.into_iter().enumerate() {
            let sum: f64 = entries.iter().filter(|entry| entry.0 == row).map(|entry| entry.2 * x[entry.1]).sum();
            assert!((sum - right).abs() < 1e-13);
        }
    }

    #[test]
    fn nan_has_no_solution() {
        assert_eq!(solve_rank_deficient(&[(0, 0, f64::NAN)], &[1.0], &[1.0]), None);
    }
}
