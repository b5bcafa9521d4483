//! The orientation of Φ_q, the sign of its determinant, where motors leave no freedom. Branches of a linkage meet where
//! it changes: near one another they have different ones.

use super::assembly::Assembly;
use crate::assemble::{ConstraintId, System};

/// The square matrix of the independent constraints.
#[derive(Clone, Debug)]
pub struct Orientation {
    /// Row of each constraint; `None` where others imply it.
    rows: Vec<Option<usize>>,
    scale: Vec<f64>,
    /// Row after row, eliminated in turn.
    matrix: Vec<f64>,
    /// Columns of the pivots so far.
    pivots: Vec<usize>,
    is_pivot: Vec<bool>,
}

/// Result of the elimination of Φ_q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oriented {
    /// Whether the determinant is negative.
    pub is_negative: bool,
    /// The constraint that is least independent of those before it.
    pub least: ConstraintId,
}

impl Orientation {
    /// For a system with these redundant constraints; `None` if the number of its independent constraints is not that
    /// of its coordinates.
    pub fn new(system: &System, redundant: &[ConstraintId]) -> Option<Self> {
        let n = system.q.len();
        let mut count = 0;
        let row = |constraint: usize| {
            let row = (!redundant.contains(&ConstraintId::new(constraint))).then_some(count);
            count += usize::from(row.is_some());
            row
        };
        let rows = (0..system.lambda.len()).map(row).collect();
        let is_square = count == n && n > 0 && system.lambda.len() == system.constraint.len();
        let scale = system.coordinates.iter().map(|coordinate| coordinate.scale).collect();
        let (matrix, is_pivot) = (vec![0.0; n * n], vec![false; n]);
        is_square.then_some(Self { rows, scale, matrix, pivots: Vec::with_capacity(n), is_pivot })
    }

    /// Eliminates Φ_q at the one lane's state; `None` if it is singular.
    pub fn at(&mut self, assembly: &mut Assembly) -> Option<Oriented> {
        let program = assembly.program();
        assembly.tile_mut().run(program.jacobian());
        self.matrix.fill(0.0);
        let n = self.scale.len();
        for &(constraint, column, register) in &program.jacobian_entries {
            if let Some(row) = self.rows[constraint] {
                self.matrix[row * n + column] += self.scale[column] * assembly.tile().lane(register)[0];
            }
        }
        let (is_negative, least) = self.eliminate()?;
        let least = self.rows.iter().position(|row| *row == Some(least))?;
        Some(Oriented { is_negative, least: ConstraintId::new(least) })
    }

    /// Whether the determinant is negative, and the row of which elimination leaves the smallest share. Each row's
    /// pivot is its largest entry.
    fn eliminate(&mut self) -> Option<(bool, usize)> {
        let n = self.scale.len();
        self.pivots.clear();
        self.is_pivot.fill(false);
        let mut is_negative = false;
        let mut least = (f64::INFINITY, 0);
        for row in 0..n {
            let (above, own) = self.matrix.split_at_mut(row * n);
            let own = &mut own[..n];
            let size = own.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
            for (&column, above) in self.pivots.iter().zip(above.chunks_exact(n)) {
                let factor = own[column] / above[column];
                if factor != 0.0 {
                    own.iter_mut().zip(above).for_each(|(own, above)| *own -= factor * above);
                    own[column] = 0.0;
                }
            }
            let free = (0..n).filter(|&column| !self.is_pivot[column]);
            let pivot = free.max_by(|&a, &b| own[a].abs().total_cmp(&own[b].abs()))?;
            let share = own[pivot].abs() / size;
            if !(share > 0.0 && share.is_finite()) {
                return None;
            }
            if share < least.0 {
                least = (share, row);
            }
            // Columns between the pivots before and this one are as many exchanges.
            let exchanges = self.pivots.iter().filter(|&&before| before > pivot).count();
            is_negative ^= (own[pivot] < 0.0) ^ (exchanges % 2 == 1);
            self.pivots.push(pivot);
            self.is_pivot[pivot] = true;
        }
        Some((is_negative, least.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn orientation_is_the_sign_of_the_determinant() {
        let n = 5;
        let mut seen = [0; 2];
        for trial in 0..40_usize {
            let entry = |index: usize| ((trial * 31 + index * 17 + 1) as f64 * 0.618_033_988_749_895).fract() - 0.4;
            let matrix: Vec<f64> = (0..n * n).map(|index| if index % 7 == 3 { 0.0 } else { entry(index) }).collect();
            let determinant = DMatrix::from_row_slice(n, n, &matrix).determinant();
            let rows = (0..n).map(Some).collect();
            let (scale, is_pivot) = (vec![1.0; n], vec![false; n]);
            let mut own = Orientation { rows, scale, matrix, pivots: Vec::new(), is_pivot };
            assert_eq!(own.eliminate().unwrap().0, determinant < 0.0, "{trial}");
            seen[usize::from(determinant < 0.0)] += 1;
        }
        assert!(seen[0] > 5 && seen[1] > 5);
    }
}
