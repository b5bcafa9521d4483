//! What to do where a matrix loses rank: dense and rank-revealing, off the hot path.

use nalgebra::{DMatrix, DVector};

/// Singular values below this share of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-9;

/// Smallest solution of `matrix · x = right` in the least-squares sense, through the singular values of the
/// symmetrically scaled matrix (x in the unscaled unknowns). `None` where the numbers are not finite.
pub fn smallest_solution(matrix: &DMatrix<f64>, right: &DVector<f64>, scale: &[f64]) -> Option<DVector<f64>> {
    let scale = DVector::from_column_slice(scale);
    let mut scaled = matrix.clone();
    for (j, mut column) in scaled.column_iter_mut().enumerate() {
        column.component_mul_assign(&scale);
        column *= scale[j];
    }
    if scaled.iter().chain(right.iter()).any(|value| !value.is_finite()) {
        return None;
    }
    let svd = scaled.try_svd(true, true, f64::EPSILON, 10_000)?;
    let cut = RANK_TOLERANCE * svd.singular_values.max();
    let solution = svd.solve(&right.component_mul(&scale), cut).ok()?;
    Some(solution.component_mul(&scale))
}

/// Rows of a sparse matrix (entries (column, value), scaled to comparable size) that the rows before them imply: found by
/// elimination in the rows' order, each time on the largest entry left.
pub fn dependent_rows(rows: &[Vec<(usize, f64)>], tolerance: f64) -> Vec<usize> {
    use std::collections::BTreeMap;
    let mut reduced: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new(); // by pivot column
    let mut dependent = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let size = row.iter().fold(0.0_f64, |size, (_, value)| size.max(value.abs()));
        let mut left: BTreeMap<usize, f64> = row.iter().copied().collect();
        // A pivot row has no entries in earlier pivots' columns only after them, so columns are cleared until none is left.
        while let Some((&column, &value)) =
            left.iter().find(|(column, value)| **value != 0.0 && reduced.contains_key(column))
        {
            for &(other, entry) in &reduced[&column] {
                *left.entry(other).or_insert(0.0) -= value * entry;
            }
            left.insert(column, 0.0);
        }
        let pivot = left.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(&column, &value)| (column, value));
        match pivot {
            Some((column, value)) if value.abs() > tolerance * size => {
                let row = left
                    .into_iter()
                    .filter(|&(_, entry)| entry != 0.0)
                    .map(|(other, entry)| (other, entry / value))
                    .collect();
                reduced.insert(column, row);
            }
            _ => dependent.push(index),
        }
    }
    dependent
}

/// Columns of a matrix that its independent rows leave free, by elimination with complete pivoting; columns of large
/// `weight` become pivots (dependent) first.
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
    fn a_singular_system_gives_its_smallest_solution() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, 1.0]);
        let x = smallest_solution(&matrix, &DVector::from_column_slice(&[2.0, 2.0]), &[1.0, 1.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12);
    }

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
