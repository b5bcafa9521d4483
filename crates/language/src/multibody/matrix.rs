//! Matrices of space, as expressions.

use std::ops::{Add, Index, IndexMut, Mul};

use symdiff::{Builder, Scalar};

use super::vector::Vector;

/// 3 × 3, by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix<'g>([Vector<'g>; 3]);

impl<'g> Matrix<'g> {
    /// The zero matrix.
    pub fn zero(g: &'g Builder) -> Self {
        Self([Vector::zero(g); 3])
    }

    /// The entry of each row and column.
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Scalar<'g>) -> Self {
        Self(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)).into()))
    }

    /// By rows.
    pub fn rows(self) -> [Vector<'g>; 3] {
        self.0
    }

    /// Σ Aᵢᵢ
    pub fn trace(self) -> Scalar<'g> {
        self.0[0][0].builder().sum((0..3).map(|i| self.0[i][i]))
    }

    /// `Aᵀ`
    pub fn transposed(self) -> Self {
        Self::from_fn(|i, j| self.0[j][i])
    }
}

impl<'g> From<[Vector<'g>; 3]> for Matrix<'g> {
    fn from(rows: [Vector<'g>; 3]) -> Self {
        Self(rows)
    }
}

impl<'g> Index<usize> for Matrix<'g> {
    type Output = Vector<'g>;

    fn index(&self, row: usize) -> &Vector<'g> {
        &self.0[row]
    }
}

impl IndexMut<usize> for Matrix<'_> {
    fn index_mut(&mut self, row: usize) -> &mut Self::Output {
        &mut self.0[row]
    }
}

impl Add for Matrix<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl<'g> Mul<Vector<'g>> for Matrix<'g> {
    type Output = Vector<'g>;

    fn mul(self, vector: Vector<'g>) -> Vector<'g> {
        self.0.map(|row| row.dot(vector)).into()
    }
}

impl Mul for Matrix<'_> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let columns = other.transposed().0;
        Self(self.0.map(|row| columns.map(|column| row.dot(column)).into()))
    }
}
