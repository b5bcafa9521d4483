//! Rank of sparse and small matrices by elimination on their numbers: dependent rows, and columns that stay free.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

/// Pivots below this share of the first one count as zero.
const RANK_TOLERANCE: f64 = 1e-9;

/// Rows of a sparse matrix (entries (column, value), scaled to comparable size) that depend on the rows before them.
pub fn dependent_rows(rows: &[Vec<(usize, f64)>], tolerance: f64) -> Vec<usize> {
    let independence = row_independence(rows, tolerance).into_iter().enumerate();
    independence.filter(|(_, left_of_row)| *left_of_row <= tolerance).map(|(row, _)| row).collect()
}

/// How independent each row of a sparse matrix is of the rows before it: the largest entry that elimination in the rows'
/// order leaves of the row, relative to the row's own size. The pivot of a row is its largest remaining entry; rows within
/// the tolerance give no pivot.
pub fn row_independence(rows: &[Vec<(usize, f64)>], tolerance: f64) -> Vec<f64> {
    let mut reduced: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new(); // by pivot column
    let mut independence = Vec::with_capacity(rows.len());
    for row in rows {
        let size = row.iter().fold(0.0_f64, |size, (_, value)| size.max(value.abs()));
        let mut left: BTreeMap<usize, f64> = row.iter().copied().collect();
        // Clearing one pivot's column may fill the column of an earlier pivot, so the loop runs until no pivot column is left.
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

/// Columns of a matrix that its independent rows leave free, found by elimination with complete pivoting. Columns of large
/// `weight` become pivots, and so dependent, first.
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
        let negligible = pivot.abs() <= RANK_TOLERANCE * largest;
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
}
