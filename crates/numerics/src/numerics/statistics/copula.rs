//! Correlated parameters: a Gaussian copula, whose correlations are those of the normal scores Φ⁻¹(F(x)).

/// A matrix of correlations that no random numbers can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositive;

/// Correlates independent normal scores; empty if the parameters are independent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Copula {
    /// Number of parameters, and the rows of the Cholesky factor; empty if all are independent.
    rows: Vec<Vec<f64>>,
}

impl Copula {
    /// Copula of a symmetric matrix with ones on its diagonal.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn new(matrix: &[Vec<f64>]) -> Result<Self, NotPositive> {
        let k = matrix.len();
        let independent = (0..k).all(|i| (0..i).all(|j| matrix[i][j] == 0.0));
        if independent {
            return Ok(Self::default());
        }
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(k);
        for (i, of_matrix) in matrix.iter().enumerate() {
            let mut row = Vec::with_capacity(i + 1);
            for (j, entry) in of_matrix[..=i].iter().enumerate() {
                let known: f64 = (0..j).map(|m| row[m] * if j == i { row[m] } else { rows[j][m] }).sum();
                let rest = entry - known;
                if j < i {
                    row.push(rest / rows[j][j]);
                } else if rest > 1e-12 {
                    row.push(rest.sqrt());
                } else {
                    return Err(NotPositive);
                }
            }
            rows.push(row);
        }
        Ok(Self { rows })
    }

    /// Whether nothing is correlated.
    pub fn is_independent(&self) -> bool {
        self.rows.is_empty()
    }

    /// Correlates independent normal scores in place.
    pub fn correlate_scores(&self, scores: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate().rev() {
            scores[i] = row.iter().zip(&*scores).map(|(weight, score)| weight * score).sum();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_have_the_correlations() {
        let matrix = vec![vec![1.0, 0.8, 0.3], vec![0.8, 1.0, 0.5], vec![0.3, 0.5, 1.0]];
        let copula = Copula::new(&matrix).unwrap();
        // L Lᵀ is the matrix: images of the unit vectors are columns of L.
        let column = |axis: usize| {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            copula.correlate_scores(&mut unit);
            unit
        };
        let columns = [column(0), column(1), column(2)];
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = columns.iter().map(|column| column[i] * column[j]).sum();
                assert!((product - matrix[i][j]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn indefinite_correlations_are_refused() {
        let matrix = vec![vec![1.0, 0.9, -0.9], vec![0.9, 1.0, 0.9], vec![-0.9, 0.9, 1.0]];
        assert_eq!(Copula::new(&matrix), Err(NotPositive));
        assert!(Copula::new(&[vec![1.0, 0.0], vec![0.0, 1.0]]).unwrap().is_independent());
    }
}
