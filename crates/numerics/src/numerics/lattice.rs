//! A lattice of Chebyshev extrema, ξᵢ = −cos(π l/Nᵢ), and estimates from its values of the function between its points.
//!
//! In θ, ξ = cos θ, the lattice is even, and a function is even and periodic: differences need no exception at the
//! box's faces.

use std::f64::consts::PI;

use super::samples::TensorGrid;
use super::tensor::cos_pi;
use super::tuning::TUNING;

/// The points, with Nᵢ intervals along each axis.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    intervals: Vec<usize>,
    /// Places from a point to the next one along each axis.
    strides: Vec<usize>,
    axes: Vec<Vec<f64>>,
    grid: TensorGrid,
}

impl Lattice {
    pub(super) fn new(intervals: &[usize]) -> Self {
        let axis = |&count: &usize| (0..=count).map(|l| 0.0 - cos_pi(l, count.max(1))).collect();
        let axes: Vec<Vec<f64>> = intervals.iter().map(axis).collect();
        let stride = |axis: usize| intervals[axis + 1..].iter().map(|count| count + 1).product();
        let strides = (0..intervals.len()).map(stride).collect();
        Self { intervals: intervals.to_vec(), strides, grid: TensorGrid::new(axes.clone()), axes }
    }

    pub(super) fn points(&self) -> Vec<Vec<f64>> {
        (0..self.grid.len()).map(|index| self.grid.sample(index)).collect()
    }

    pub(super) fn point(&self, index: usize) -> Vec<f64> {
        self.grid.sample(index)
    }

    /// Distances to the neighbours of a point along each axis, the larger of both; near a face not less than some share
    /// of that in the middle.
    pub(super) fn spacing(&self, index: usize) -> Vec<f64> {
        let of_axis = |axis: usize, at: usize| {
            let points = &self.axes[axis];
            let before = at.checked_sub(1).map_or(0.0, |before| points[at] - points[before]);
            let after = points.get(at + 1).map_or(0.0, |after| after - points[at]);
            before.max(after).max(TUNING.at_face * PI / self.intervals[axis] as f64)
        };
        self.indices(index).enumerate().map(|(axis, at)| of_axis(axis, at)).collect()
    }

    /// Place along each axis.
    fn indices(&self, index: usize) -> impl Iterator<Item = usize> {
        self.strides.iter().zip(&self.intervals).map(move |(stride, count)| index / stride % (count + 1))
    }

    /// The values at a point and at those one and two further along an axis, mirrored at the faces: two before, before,
    /// here, after, two after.
    fn along(&self, values: &[f64], place: usize, axis: usize, at: usize) -> [f64; 5] {
        let stride = self.strides[axis];
        if at >= 2 && at + 2 <= self.intervals[axis] {
            let first = &values[place - 2 * stride..];
            return [first[0], first[stride], first[2 * stride], first[3 * stride], first[4 * stride]];
        }
        let count = self.intervals[axis] as isize;
        [-2, -1, 0, 1, 2].map(|away| {
            let index = (at as isize + away).rem_euclid(2 * count);
            let mirrored = index.min(2 * count - index) as usize;
            values[place + stride * mirrored - stride * at]
        })
    }

    /// Along each axis, the largest difference of a value from the prediction of its neighbours: a sixth of the fourth
    /// difference.
    pub(super) fn residuals(&self, values: &[f64]) -> Vec<f64> {
        let mut residuals = vec![0.0_f64; self.intervals.len()];
        for index in 0..values.len() {
            for (axis, at) in self.indices(index).enumerate() {
                residuals[axis] = residuals[axis].max(residual(self.along(values, index, axis, at)));
            }
        }
        residuals
    }

    /// Points that are at least as high as their neighbours along each axis, and how high the function may be near
    /// each.
    pub(super) fn peaks(&self, values: &[f64], sign: f64) -> Vec<(usize, f64)> {
        let mut peaks = Vec::new();
        for index in 0..values.len() {
            let mut height = sign * values[index];
            let is_peak = self.indices(index).enumerate().all(|(axis, at)| {
                let line = self.along(values, index, axis, at);
                let [_, before, here, after, _] = line;
                height += (before - 2.0 * here + after).abs() / 8.0 + residual(line);
                sign * here >= sign * before && sign * here >= sign * after
            });
            if is_peak {
                peaks.push((index, height));
            }
        }
        peaks
    }
}

/// Distance of the middle one of five values from the cubic through the others.
fn residual([a, b, c, d, e]: [f64; 5]) -> f64 {
    (a - 4.0 * b + 6.0 * c - 4.0 * d + e).abs() / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattice_has_points_at_ends_and_middle_with_spacings() {
        let lattice = Lattice::new(&[4, 8]);
        let points = lattice.points();
        assert_eq!((points.len(), &points[0], &points[22]), (45, &vec![-1.0, -1.0], &vec![0.0, 0.0]));
        let spacing = lattice.spacing(22);
        assert!((spacing[0] - 0.5_f64.sqrt()).abs() < 1e-15 && spacing[1] < 0.383);
        assert!(lattice.spacing(0)[0] < 0.293 && lattice.spacing(0)[1] > 0.117);
    }

    #[test]
    fn residuals_are_small_and_peaks_on_faces_are_found() {
        let lattice = Lattice::new(&[32, 16]);
        let f = |xi: &Vec<f64>| (4.0 * xi[0]).cos() + 0.2 * xi[1];
        let values: Vec<f64> = lattice.points().iter().map(f).collect();
        let residuals = lattice.residuals(&values);
        assert!(residuals[0] < 0.03 && residuals[0] > 1e-3 && residuals[1] < 1e-3, "{residuals:?}");
        let peaks: Vec<Vec<f64>> = lattice.peaks(&values, 1.0).iter().map(|peak| lattice.point(peak.0)).collect();
        assert_eq!(peaks, [[-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]]);
        assert_eq!(lattice.peaks(&values, -1.0).len(), 2);
    }
}
