//! Matrices of Taylor models.

use std::ops::Range;

use nalgebra::DMatrix;
use symdiff::taylor_model::{ModelSpace, Norms};

use super::tuning::TUNING;
use crate::numerics::larger;

/// A matrix whose entries are functions of ξ, enclosed.
#[derive(Clone, Debug)]
pub struct Models {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    size: usize,
    values: Vec<f64>,
}

impl Models {
    /// Zeros.
    pub fn zero(space: &ModelSpace, rows: usize, columns: usize) -> Self {
        let size = space.size();
        Self { rows, columns, size, values: vec![0.0; rows * columns * size] }
    }

    /// I.
    pub fn identity(space: &ModelSpace, dimension: usize) -> Self {
        let mut identity = Self::zero(space, dimension, dimension);
        (0..dimension).for_each(|i| identity.at_mut(i, i)[0] = 1.0);
        identity
    }

    /// Numbers that do not depend on ξ.
    pub fn constant(space: &ModelSpace, numbers: &DMatrix<f64>) -> Self {
        let mut models = Self::zero(space, numbers.nrows(), numbers.ncols());
        for row in 0..models.rows {
            (0..models.columns).for_each(|column| models.at_mut(row, column)[0] = numbers[(row, column)]);
        }
        models
    }

    /// An entry's model.
    pub fn at(&self, row: usize, column: usize) -> &[f64] {
        &self.values[(row * self.columns + column) * self.size..][..self.size]
    }

    /// An entry's model.
    pub fn at_mut(&mut self, row: usize, column: usize) -> &mut [f64] {
        &mut self.values[(row * self.columns + column) * self.size..][..self.size]
    }

    /// All entries of a row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns * self.size..][..self.columns * self.size]
    }

    /// Some rows and columns.
    pub fn part(&self, space: &ModelSpace, rows: Range<usize>, columns: Range<usize>) -> Self {
        let mut part = Self::zero(space, rows.len(), columns.len());
        for (index, row) in rows.enumerate() {
            let length = columns.len() * self.size;
            part.values[index * length..][..length]
                .copy_from_slice(&self.row(row)[columns.start * self.size..][..length]);
        }
        part
    }

    /// Some columns.
    pub fn columns_at(&self, space: &ModelSpace, columns: &[usize]) -> Self {
        let mut chosen = Self::zero(space, self.rows, columns.len());
        for row in 0..self.rows {
            for (index, &column) in columns.iter().enumerate() {
                chosen.at_mut(row, index).copy_from_slice(self.at(row, column));
            }
        }
        chosen
    }

    /// [self, other].
    pub fn beside(&self, space: &ModelSpace, other: &Self) -> Self {
        let mut both = Self::zero(space, self.rows, self.columns + other.columns);
        for row in 0..self.rows {
            let (left, right) = (self.row(row), other.row(row));
            let length = left.len() + right.len();
            both.values[row * length..][..left.len()].copy_from_slice(left);
            both.values[row * length + left.len()..][..right.len()].copy_from_slice(right);
        }
        both
    }

    /// Multiplies a row by a power of two.
    pub fn scale_row(&mut self, row: usize, factor: f64) {
        let length = self.columns * self.size;
        self.values[row * length..][..length].iter_mut().for_each(|c| *c *= factor);
    }

    /// Removes the radii.
    pub fn without_radii(mut self) -> Self {
        self.values.chunks_exact_mut(self.size).for_each(|model| model[self.size - 1] = 0.0);
        self
    }

    fn norms(&self, space: &ModelSpace) -> Vec<Option<Norms>> {
        let norms = |model: &[f64]| model.iter().any(|&c| c != 0.0).then(|| space.norms(model));
        self.values.chunks_exact(self.size).map(norms).collect()
    }

    /// Bound of each entry's absolute value.
    pub fn bounds(&self, space: &ModelSpace) -> Bounds {
        let values = self.values.chunks_exact(self.size).map(|model| space.bound(model)).collect();
        Bounds { rows: self.rows, columns: self.columns, values }
    }

    /// `self · other`.
    pub fn times(&self, space: &ModelSpace, other: &Self) -> Self {
        let mut product = Self::zero(space, self.rows, other.columns);
        let (left, right) = (self.norms(space), other.norms(space));
        for row in 0..self.rows {
            for inner in 0..self.columns {
                let Some(a) = &left[row * self.columns + inner] else { continue };
                for column in 0..other.columns {
                    if let Some(b) = &right[inner * other.columns + column] {
                        let (a, b) = ((self.at(row, inner), a), (other.at(inner, column), b));
                        space.accumulate(a, b, self.columns, product.at_mut(row, column));
                    }
                }
            }
        }
        product
    }

    /// The polynomials of `self · other`, without bounds of their errors.
    pub fn approximate_times(&self, space: &ModelSpace, other: &Self) -> Self {
        let mut product = Self::zero(space, self.rows, other.columns);
        let length = self.size - 1;
        let is_zero = |model: &[f64]| model[..length].iter().all(|&c| c == 0.0);
        let sparse: Vec<bool> = other.values.chunks_exact(self.size).map(is_zero).collect();
        for row in 0..self.rows {
            for inner in (0..self.columns).filter(|&inner| !is_zero(self.at(row, inner))) {
                for column in (0..other.columns).filter(|column| !sparse[inner * other.columns + column]) {
                    let out = &mut product.at_mut(row, column)[..length];
                    space.jets().accumulate(&self.at(row, inner)[..length], &other.at(inner, column)[..length], out);
                }
            }
        }
        product
    }

    /// I − self, for a square matrix.
    pub fn off_identity(mut self, space: &ModelSpace) -> Self {
        self.negate();
        let one = Self::identity(space, 1);
        for i in 0..self.rows {
            let entry = self.at(i, i).to_vec();
            space.add(one.at(0, 0), &entry, self.at_mut(i, i));
        }
        self
    }

    /// `self ← −self`.
    pub fn negate(&mut self) {
        self.values
            .chunks_exact_mut(self.size)
            .for_each(|model| model[..self.size - 1].iter_mut().for_each(|c| *c = -*c));
    }

    /// `self += other`.
    pub fn add(&mut self, space: &ModelSpace, other: &Self) {
        let mut sum = vec![0.0; self.size];
        for (a, b) in self.values.chunks_exact_mut(self.size).zip(other.values.chunks_exact(self.size)) {
            space.add(a, b, &mut sum);
            a.copy_from_slice(&sum);
        }
    }

    /// `self += factor · other`, polynomials only.
    pub fn add_scaled(&mut self, other: &Self, factor: f64) {
        for (a, b) in self.values.chunks_exact_mut(self.size).zip(other.values.chunks_exact(self.size)) {
            a[..self.size - 1].iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
        }
    }

    /// `self += other`, polynomials only.
    pub fn add_approximately(&mut self, other: &Self) {
        self.add_scaled(other, 1.0);
    }

    /// Largest sum of a row's bounds.
    pub fn row_norm(&self, space: &ModelSpace) -> f64 {
        self.bounds(space).rows().map(|row| row.iter().sum::<f64>()).fold(0.0, larger)
    }

    /// The inverse at the box's centre, as constants; `None` if the matrix is singular there.
    pub fn inverse_at_centre(&self, space: &ModelSpace) -> Option<Self> {
        let centre = DMatrix::from_fn(self.rows, self.columns, |row, column| self.at(row, column)[0]);
        let inverse = centre.try_inverse()?;
        Some(Self::constant(space, &inverse))
    }

    /// Makes `self` a better inverse of a matrix: C ← C + (I − C J) C (Schulz). Returns whether it is an inverse.
    pub fn refine_inverse_of(&mut self, space: &ModelSpace, matrix: &Self) -> bool {
        let mut last = f64::INFINITY;
        for _ in 0..TUNING.max_refinements {
            let rest = self.approximate_times(space, matrix).off_identity(space);
            let norm = rest.row_norm(space);
            if norm <= TUNING.refined_inverse || norm >= last {
                break;
            }
            last = norm;
            let change = rest.approximate_times(space, self);
            self.add_approximately(&change);
        }
        last < 1.0 || last.is_infinite()
    }
}

/// Bounds of the absolute values of a matrix's entries. A matrix without columns has rows: a mechanism without degrees
/// of freedom has such matrices.
#[derive(Clone, Debug, Default)]
pub struct Bounds {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Bounds {
    /// A matrix with this number of columns, from its entries row by row.
    ///
    /// # Panics
    /// If the number of values is not `rows` × `columns`.
    pub fn of(rows: usize, columns: usize, values: &[f64]) -> Self {
        assert_eq!(values.len(), rows * columns);
        Self { rows, columns, values: values.to_vec() }
    }

    /// An entry.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// A column.
    pub fn column(&self, column: usize) -> Vec<f64> {
        (0..self.rows).map(|row| self.at(row, column)).collect()
    }

    /// Number of rows and of columns.
    pub fn shape(&self) -> (usize, usize) {
        (self.rows, self.columns)
    }

    /// All entries, row by row.
    pub fn entries(&self) -> &[f64] {
        &self.values
    }

    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.rows).map(|row| &self.values[row * self.columns..][..self.columns])
    }

    /// Σ_j aᵢⱼ xⱼ, row by row, rounded up; x is not negative.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        debug_assert_eq!(x.len(), self.columns);
        self.rows().map(|row| symdiff::taylor_model::up(row.iter().zip(x).map(|(a, x)| a * x).sum())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Bounds;

    #[test]
    fn a_matrix_without_columns_has_rows() {
        let empty = Bounds::of(3, 0, &[]);
        assert_eq!(empty.rows().count(), 3);
        // Sums of nothing, rounded outwards.
        let sums = empty.times(&[]);
        assert_eq!(sums.len(), 3);
        assert!(sums.iter().all(|sum| (0.0..1e-280).contains(sum)), "{sums:?}");
        assert_eq!(Bounds::of(0, 2, &[]).times(&[1.0, 2.0]), [0.0; 0]);
    }
}
