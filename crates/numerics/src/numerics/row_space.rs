//! The space that the rows of a small matrix span, and its orthogonal complement.
//!
//! Modified Gram–Schmidt with pivoting, each vector orthogonalised twice ("twice is enough": Giraud, Langou, Rozložník
//! & van den Eshof, Numer. Math. 101 (2005) 87). Plain loops, so that results are the same bits on every processor.

use super::tuning::TUNING;

/// A = L B for the independent rows of A, with orthonormal rows of B, and an orthonormal basis of the null space of A.
#[derive(Clone, Debug, Default)]
pub struct RowSpace {
    /// Numbers of the independent rows, in the order of B's.
    pub independent: Vec<usize>,
    /// B: orthonormal vectors of n entries each.
    pub basis: Vec<Vec<f64>>,
    /// Rows of L up to the diagonal.
    lower: Vec<Vec<f64>>,
    /// Orthonormal vectors of n entries each.
    pub null: Vec<Vec<f64>>,
}

impl RowSpace {
    /// Space of rows of n entries each.
    pub fn of(rows: &[Vec<f64>], n: usize) -> Self {
        let sizes: Vec<f64> = rows.iter().map(|row| norm(row)).collect();
        let mut left: Vec<Vec<f64>> = rows.to_vec();
        let mut space = Self::default();
        let mut open: Vec<usize> = (0..rows.len()).filter(|&row| sizes[row] > 0.0).collect();
        loop {
            let share = |row: usize| norm(&left[row]) / sizes[row];
            let Some(index) = (0..open.len()).reduce(|a, b| if share(open[b]) > share(open[a]) { b } else { a }) else {
                break;
            };
            let row = open.remove(index);
            let mut vector = rows[row].clone();
            let mut part = vec![0.0; space.basis.len() + 1];
            orthogonalise(&mut vector, &space.basis, &mut part);
            let size = norm(&vector);
            // NaN is dependent.
            if size.is_nan() || size <= TUNING.dependent_row * sizes[row] || space.basis.len() == n {
                break;
            }
            vector.iter_mut().for_each(|entry| *entry /= size);
            part[space.basis.len()] = size;
            for &other in &open {
                subtract(&mut left[other], &vector);
            }
            space.lower.push(part);
            space.basis.push(vector);
            space.independent.push(row);
        }
        space.complete(n);
        space
    }

    /// Basis of the orthogonal complement of all rows: from the unit vectors with the largest remainders.
    fn complete(&mut self, n: usize) {
        let unit = |index: usize| (0..n).map(|entry| if entry == index { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let mut left: Vec<Vec<f64>> = (0..n).map(unit).collect();
        for vector in &self.basis {
            left.iter_mut().for_each(|other| subtract(other, vector));
        }
        let mut open: Vec<usize> = (0..n).collect();
        while self.null.len() + self.basis.len() < n {
            let longest =
                (0..open.len()).reduce(|a, b| if norm(&left[open[b]]) > norm(&left[open[a]]) { b } else { a });
            let Some(longest) = longest else { break };
            let mut vector = unit(open.remove(longest));
            orthogonalise(&mut vector, &self.basis, &mut []);
            orthogonalise(&mut vector, &self.null, &mut []);
            orthogonalise(&mut vector, &self.basis, &mut []);
            let size = norm(&vector);
            vector.iter_mut().for_each(|entry| *entry /= size);
            open.iter().for_each(|&other| subtract(&mut left[other], &vector));
            self.null.push(vector);
        }
    }

    /// The shortest x (n) with A x = `right`, as far as the independent rows go.
    pub fn shortest(&self, right: &[f64]) -> Vec<f64> {
        let n = self.basis.iter().chain(&self.null).next().map_or(0, Vec::len);
        let mut along: Vec<f64> = Vec::with_capacity(self.basis.len());
        for (lower, &row) in self.lower.iter().zip(&self.independent) {
            let known: f64 = lower.iter().zip(&along).map(|(entry, value)| entry * value).sum();
            along.push((right[row] - known) / lower[along.len()]);
        }
        combined(&self.basis, &along, n)
    }

    /// y with Aᵀ y nearest to `right` (n); zero for dependent rows. One entry a row, `rows` in all.
    pub fn multipliers(&self, right: &[f64], rows: usize) -> Vec<f64> {
        let mut along: Vec<f64> = self.basis.iter().map(|vector| dot(vector, right)).collect();
        let mut found = vec![0.0; rows];
        for index in (0..along.len()).rev() {
            along[index] /= self.lower[index][index];
            let value = along[index];
            (0..index).for_each(|earlier| along[earlier] -= self.lower[index][earlier] * value);
            found[self.independent[index]] = value;
        }
        found
    }
}

/// Σ c_i v_i, n entries.
pub fn combined(vectors: &[Vec<f64>], coefficients: &[f64], n: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n];
    for (vector, coefficient) in vectors.iter().zip(coefficients) {
        sum.iter_mut().zip(vector).for_each(|(sum, entry)| *sum += coefficient * entry);
    }
    sum
}

/// a · b
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// Removes the component along a unit vector from another one.
fn subtract(from: &mut [f64], along: &[f64]) {
    let part = dot(from, along);
    from.iter_mut().zip(along).for_each(|(entry, along)| *entry -= part * along);
}

/// Twice; `parts` get the removed components.
fn orthogonalise(vector: &mut [f64], basis: &[Vec<f64>], parts: &mut [f64]) {
    for _ in 0..2 {
        for (index, along) in basis.iter().enumerate() {
            let part = dot(vector, along);
            vector.iter_mut().zip(along).for_each(|(entry, along)| *entry -= part * along);
            if let Some(total) = parts.get_mut(index) {
                *total += part;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Vec<f64>> {
        // The third is the sum of the first two.
        vec![vec![1.0, 2.0, 0.0, -1.0], vec![0.0, 1e-3, 3e-3, 0.0], vec![1.0, 2.001, 3e-3, -1.0]]
    }

    #[test]
    fn basis_omits_dependent_rows_and_is_orthonormal() {
        let space = RowSpace::of(&rows(), 4);
        assert_eq!((space.independent.len(), space.null.len()), (2, 2));
        let all: Vec<&Vec<f64>> = space.basis.iter().chain(&space.null).collect();
        for (i, a) in all.iter().enumerate() {
            for (j, b) in all.iter().enumerate() {
                let wanted = if i == j { 1.0 } else { 0.0 };
                assert!((dot(a, b) - wanted).abs() < 1e-14, "{i} {j}");
            }
        }
        for (row, null) in rows().iter().flat_map(|row| space.null.iter().map(move |null| (row.clone(), null))) {
            assert!(dot(&row, null).abs() < 1e-14);
        }
    }

    #[test]
    fn equations_and_multipliers_are_solved() {
        let space = RowSpace::of(&rows(), 4);
        let x = space.shortest(&[1.0, 2.0, 3.0]);
        for (row, right) in rows().iter().zip([1.0, 2.0, 3.0]) {
            assert!((dot(row, &x) - right).abs() < 1e-11);
        }
        let y = space.multipliers(&combined(&rows(), &[0.5, -2.0, 0.0], 4), 3);
        let back = combined(&rows(), &y, 4);
        let wanted = combined(&rows(), &[0.5, -2.0, 0.0], 4);
        assert!(back.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?} {wanted:?}");
    }
}
