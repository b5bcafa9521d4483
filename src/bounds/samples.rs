//! Tensor grids of samples in [−1, 1]^k: which parameter values a method runs.

use super::tensor::cos_pi;

/// All combinations of one coordinate from each axis. Samples are numbered with the last axis fastest and made one at
/// a time, so that a plan of any size can be split by ranges of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorGrid {
    axes: Vec<Vec<f64>>,
}

impl TensorGrid {
    /// From each axis' coordinates.
    pub fn new(axes: Vec<Vec<f64>>) -> Self {
        Self { axes }
    }

    /// Equally spaced, both ends included; a single point is the middle.
    pub fn full_factorial(points: &[usize]) -> Self {
        let axis = |&points: &usize| match points {
            1 => vec![0.0],
            // Numerators are whole numbers, so the axis is symmetric and its ends are ±1 to the bit.
            _ => (0..points).map(|j| (2.0 * j as f64 - (points - 1) as f64) / (points - 1) as f64).collect(),
        };
        Self::new(points.iter().map(axis).collect())
    }

    /// The zeros of C_m along each axis: cos θ_j, θ_j = (2j − 1)/m · π/2, j = 1…m (descending), the paper's (17).
    pub fn chebyshev_zeros(nodes: &[usize]) -> Self {
        let axis = |&m: &usize| (1..=m).map(|j| cos_pi(2 * j - 1, 2 * m)).collect();
        Self::new(nodes.iter().map(axis).collect())
    }

    /// Number of axes, k.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    /// Coordinates along one axis.
    pub fn axis(&self, axis: usize) -> &[f64] {
        &self.axes[axis]
    }

    /// Number of samples; `usize::MAX` if it does not fit (such a grid can be counted, not run).
    #[allow(clippy::len_without_is_empty)] // every axis has a point
    pub fn len(&self) -> usize {
        self.axes.iter().fold(1, |count, axis| count.saturating_mul(axis.len()))
    }

    /// Writes the coordinates of a sample; `out` has k entries.
    pub fn fill(&self, index: usize, out: &mut [f64]) {
        let mut rest = index;
        for (xi, axis) in out.iter_mut().zip(&self.axes).rev() {
            *xi = axis[rest % axis.len()];
            rest /= axis.len();
        }
    }

    /// The coordinates of a sample.
    pub fn sample(&self, index: usize) -> Vec<f64> {
        let mut out = vec![0.0; self.dimension()];
        self.fill(index, &mut out);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_runs_fastest() {
        let grid = TensorGrid::full_factorial(&[2, 1, 3]);
        let all: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
        let expected =
            [[-1.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]];
        assert_eq!(all, expected);
    }

    #[test]
    fn thirty_points_are_symmetric_and_reach_both_ends() {
        let grid = TensorGrid::full_factorial(&[30]);
        let axis = grid.axis(0);
        assert_eq!((axis[0], axis[29]), (-1.0, 1.0));
        assert!((0..30).all(|j| axis[j] == -axis[29 - j]));
    }

    #[test]
    fn chebyshev_zeros_are_zeros() {
        let grid = TensorGrid::chebyshev_zeros(&[1, 2, 3]);
        assert_eq!(grid.axis(0), [0.0]);
        assert!((grid.axis(1)[0] - 0.5_f64.sqrt()).abs() < 1e-16 && grid.axis(1)[1] == -grid.axis(1)[0]);
        assert!((grid.axis(2)[0] - 0.75_f64.sqrt()).abs() < 1.2e-16 && grid.axis(2)[1] == 0.0);
    }

    #[test]
    fn no_parameters_make_one_sample_and_too_many_are_still_counted() {
        assert_eq!(TensorGrid::full_factorial(&[]).len(), 1);
        assert_eq!(TensorGrid::full_factorial(&[30; 14]).len(), usize::MAX);
    }
}
