//! Factors of the start's corrections, shared by those that have the same matrix.

use symdiff::SparseMatrix;

use super::sparse_lu::Factors;

/// A matrix with its factors: corrections of positions and velocities often have one matrix, those of accelerations
/// and impulses too.
pub(super) struct Factorised {
    /// The matrix.
    pub matrix: SparseMatrix,
    /// Coordinates and the rows of the constraints that define them.
    pub pairs: Vec<(usize, usize)>,
    /// The first row that is searched last.
    pub late: usize,
    /// Its factors.
    pub factors: Factors,
}

impl Factorised {
    /// Whether the factors are those of a matrix.
    pub fn is_of(&self, matrix: &SparseMatrix, pairs: &[(usize, usize)], late: usize) -> bool {
        self.late == late && self.pairs == pairs && self.matrix == *matrix
    }
}
