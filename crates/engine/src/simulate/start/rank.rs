//! Rank of sparse and small matrices by elimination on their numbers: dependent rows, and columns that stay free.

use std::collections::BTreeMap;

use super::tuning::TUNING;
use nalgebra::DMatrix;

/// Rows of a sparse matrix (entries (column, value), scaled to comparable size) that depend on the rows before them.
pub fn dependent_rows(rows: &[Vec<(usize, f64)>], tolerance: f64) -> Vec<usize> {
    dependent_of_sizes(rows, &vec![0.0; rows.len()], tolerance)
}

/// The same where a row that is much smaller than its usual size counts as dependent too.
pub fn dependent_of_sizes(rows: &[Vec<(usize, f64)>], usual: &[f64], tolerance: f64) -> Vec<usize> {
    let left = rows_with_shared_columns(rows, usual);
    let shared: Vec<&[(usize, f64)]> = left.iter().map(|&row| rows[row].as_slice()).collect();
    let sizes: Vec<f64> = left.iter().map(|&row| usual[row]).collect();
    let independence = left.iter().zip(row_independence(&shared, &sizes, tolerance));
    independence.filter(|(_, left_of_row)| *left_of_row <= tolerance).map(|(&row, _)| row).collect()
}

/// Rows that are left when, again and again, a row is taken away that has a large entry in a column of its own: that
/// row is a part of no combination that vanishes, so dependence is among the others. What hangs together as a tree
/// leaves none, in linear time.
fn rows_with_shared_columns(rows: &[Vec<(usize, f64)>], usual: &[f64]) -> Vec<usize> {
    let columns = rows.iter().flatten().map(|&(column, _)| column + 1).max().unwrap_or(0);
    let mut rows_of_column: Vec<Vec<usize>> = vec![Vec::new(); columns];
    for (row, entries) in rows.iter().enumerate() {
        let nonzero = entries.iter().filter(|(_, value)| *value != 0.0);
        nonzero.for_each(|&(column, _)| rows_of_column[column].push(row));
    }
    rows_of_column.iter_mut().for_each(Vec::dedup);
    let mut users: Vec<usize> = rows_of_column.iter().map(Vec::len).collect();
    let mut is_left = vec![true; rows.len()];
    let mut single: Vec<usize> = (0..columns).filter(|&column| users[column] == 1).collect();
    while let Some(column) = single.pop() {
        let Some(&row) = rows_of_column[column].iter().find(|&&row| is_left[row]) else { continue };
        let size = row_size(&rows[row]).max(usual[row]);
        let own: f64 = rows[row].iter().filter(|(other, _)| *other == column).map(|(_, value)| value).sum();
        if own.abs() < TUNING.own_share * size {
            continue;
        }
        is_left[row] = false;
        let mut released: Vec<usize> =
            rows[row].iter().filter(|(_, value)| *value != 0.0).map(|&(other, _)| other).collect();
        released.sort_unstable();
        released.dedup();
        for other in released {
            users[other] -= 1;
            single.extend((users[other] == 1).then_some(other));
        }
    }
    (0..rows.len()).filter(|&row| is_left[row]).collect()
}

/// Independence of each row of a sparse matrix of the rows before it: the largest entry that elimination in the rows'
/// order leaves of the row, relative to the row's own size or its usual one, whichever is larger. The pivot of a row is
/// its largest remaining entry; rows within the tolerance give no pivot.
pub fn row_independence(rows: &[impl AsRef<[(usize, f64)]>], usual: &[f64], tolerance: f64) -> Vec<f64> {
    let mut reduced: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new(); // by pivot column
    let mut independence = Vec::with_capacity(rows.len());
    for (row, &usual) in rows.iter().map(AsRef::as_ref).zip(usual) {
        let size = row_size(row).max(usual);
        let mut left: BTreeMap<usize, f64> = row.iter().copied().collect();
        // Clearing one pivot's column may fill the column of an earlier pivot, so the loop runs until no pivot column
        // is left.
        while let Some((&column, &value)) =
            left.iter().find(|(column, value)| **value != 0.0 && reduced.contains_key(column))
        {
            for &(other, entry) in &reduced[&column] {
                *left.entry(other).or_insert(0.0) -= value * entry;
            }
            left.insert(column, 0.0);
        }
        let pivot = left.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(&column, &value)| (column, value));
        let left_of_row = pivot.map_or(0.0, |(_, value)| if size > 0.0 { value.abs() / size } else { 0.0 });
        independence.push(left_of_row);
        if let Some((column, value)) = pivot.filter(|_| left_of_row > tolerance) {
            let row = left
                .into_iter()
                .filter(|&(_, entry)| entry != 0.0)
                .map(|(other, entry)| (other, entry / value))
                .collect();
            reduced.insert(column, row);
        }
    }
    independence
}

/// The largest entry of a row.
pub fn row_size(row: &[(usize, f64)]) -> f64 {
    row.iter().fold(0.0, |size, (_, value)| size.max(value.abs()))
}

/// Columns of a matrix that its independent rows leave free, found by elimination with complete pivoting. Columns of
/// large `weight` become pivots, and so dependent, first.
pub fn free_columns(matrix: &DMatrix<f64>, weight: &[f64]) -> Vec<usize> {
    let mut left = matrix.clone();
    let mut free: Vec<usize> = (0..matrix.ncols()).collect();
    let mut rows: Vec<usize> = (0..matrix.nrows()).collect();
    let mut first = None;
    while !rows.is_empty() && !free.is_empty() {
        let entries = rows.iter().flat_map(|&row| free.iter().map(move |&column| (row, column)));
        let size = |&(row, column): &(usize, usize)| left[(row, column)].abs() * weight[column];
        let Some((row, column)) = entries.max_by(|a, b| size(a).total_cmp(&size(b))) else { break };
        let pivot = left[(row, column)];
        let largest = *first.get_or_insert(pivot.abs());
        let negligible = pivot.abs() <= TUNING.rank_tolerance * largest;
        if negligible || !pivot.is_finite() {
            break;
        }
        rows.retain(|&other| other != row);
        free.retain(|&other| other != column);
        for &other in &rows {
            let factor = left[(other, column)] / pivot;
            if factor != 0.0 {
                for &right in &free {
                    left[(other, right)] -= factor * left[(row, right)];
                }
            }
        }
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implied_rows_are_found_in_order() {
        let rows = vec![
            vec![(0, 1.0), (1, 2.0)],
            vec![(1, 1.0), (2, 1.0)],
            vec![(0, 1.0), (1, 3.0), (2, 1.0)],
            vec![(2, 5.0)],
            vec![],
        ];
        assert_eq!(dependent_rows(&rows, 1e-9), [2, 4]);
    }

    /// Whatever hangs on a loop, and wherever its rows stand, as many rows depend on others as without it.
    #[test]
    fn rows_with_private_columns_hide_no_dependence() {
        let triangle = [vec![(0, 1.0), (1, -1.0)], vec![(1, 1.0), (2, -1.0)], vec![(2, 1.0), (0, -1.0)]];
        let tail = |from: usize, to: usize| vec![(from, 2.0), (to, -3.0)];
        let [first, second, third] = triangle;
        let rows = vec![tail(3, 4), first, tail(2, 3), second, third, tail(4, 5)];
        assert_eq!(dependent_rows(&rows, 1e-9), [4]);
        assert_eq!(rows_with_shared_columns(&rows, &[0.0; 6]), [1, 3, 4]);
        let weak = vec![vec![(0, 1.0), (1, 1e-5)], vec![(0, 1.0)]];
        // 1e-5 of a row is too little to distinguish it: both are eliminated, and neither depends on the other.
        assert_eq!(rows_with_shared_columns(&weak, &[0.0; 2]), [0, 1]);
        assert!(dependent_rows(&weak, 1e-9).is_empty());
        let no_tail = vec![vec![(0, 1.0), (1, 0.0)], vec![(0, 2.0), (1, 0.0)]];
        assert_eq!(dependent_rows(&no_tail, 1e-9), [1]);
    }

    #[test]
    fn row_of_rounding_errors_is_dependent() {
        let rows = vec![vec![(0, 1e-16), (1, -2e-16)], vec![(1, 1.0)]];
        assert!(dependent_rows(&rows, 1e-9).is_empty());
        assert_eq!(dependent_of_sizes(&rows, &[0.5, 0.5], 1e-9), [0]);
    }
}
