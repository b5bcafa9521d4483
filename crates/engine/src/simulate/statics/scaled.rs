//! A matrix with rows and columns of the size one: rates of states are of any size, and so are their arguments.

use nalgebra::DMatrix;

/// diag(rows) A diag(columns).
pub(super) struct Scaled {
    pub matrix: DMatrix<f64>,
    /// Factors of rows and columns; 1 of those that are zero.
    pub rows: Vec<f64>,
    pub columns: Vec<f64>,
}

impl Scaled {
    /// Scales a matrix A.
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let mut matrix = matrix.clone();
        let inverse = |size: f64| if size > 0.0 { size.recip() } else { 1.0 };
        let rows: Vec<f64> = matrix.row_iter().map(|row| inverse(row.amax())).collect();
        matrix.row_iter_mut().zip(&rows).for_each(|(mut row, factor)| row *= *factor);
        let columns: Vec<f64> = matrix.column_iter().map(|column| inverse(column.amax())).collect();
        matrix.column_iter_mut().zip(&columns).for_each(|(mut column, factor)| column *= *factor);
        Self { matrix, rows, columns }
    }

    /// A as it is.
    pub fn not(matrix: DMatrix<f64>) -> Self {
        let (rows, columns) = (vec![1.0; matrix.nrows()], vec![1.0; matrix.ncols()]);
        Self { matrix, rows, columns }
    }
}
