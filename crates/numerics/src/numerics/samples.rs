//! Tensor grids of samples in [−1, 1]^k: which parameter values a method runs.

use std::collections::{BTreeMap, BTreeSet};

use super::tensor::cos_pi;
use super::tuning::TUNING;

/// All combinations of one coordinate from each axis. Samples are numbered with the last axis fastest and made one at
/// a time, so that a plan of any size can be split by ranges of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorGrid {
    axes: Vec<Vec<f64>>,
}

impl TensorGrid {
    /// Grid from each axis' coordinates.
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
    #[cfg(test)]
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

/// Corners of [−1, 1]^k: all if they are not more than `most` (a power of two), else `most` of them such that any two
/// axes, unless their indices differ by a multiple of `most` − 1, meet at every pair of their ends (the signs of Walsh
/// functions).
pub fn corners(k: usize, most: usize) -> Vec<Vec<f64>> {
    let all = k < usize::BITS as usize && 1 << k <= most;
    let mask = |axis: usize| if all { 1 << axis } else { axis % (most - 1) + 1 };
    let sign = |index: usize, axis: usize| if (index & mask(axis)).count_ones().is_multiple_of(2) { -1.0 } else { 1.0 };
    (0..if all { 1 << k } else { most }).map(|index| (0..k).map(|axis| sign(index, axis)).collect()).collect()
}

/// `count` points spread evenly over the inside of the box (the additive recurrence of Kronecker).
pub fn spread(k: usize, count: usize) -> Vec<Vec<f64>> {
    // Roberts' generalisation of the golden ratio: the root of x^(k+1) = x + 1.
    let mut ratio = 1.5_f64;
    for _ in 0..100 {
        ratio -= (ratio.powi(k as i32 + 1) - ratio - 1.0) / ((k + 1) as f64 * ratio.powi(k as i32) - 1.0);
    }
    let at = |index: usize, axis: usize| (0.5 + (index + 1) as f64 * ratio.powi(-(axis as i32 + 1))).fract();
    (0..count).map(|index| (0..k).map(|axis| 2.0 * at(index, axis) - 1.0).collect()).collect()
}

/// All points at which a surrogate of this degree is compared with the simulation: [`step_validation`], then points
/// held out, at least two more than the degree: a polynomial that wiggles as often as it can shows at one of them.
pub fn validation(k: usize, degree: usize) -> Vec<Vec<f64>> {
    let mut points = step_validation(k);
    points.extend(spread(k, if k == 0 { 0 } else { TUNING.held_out.max(k).max(degree + 2) }));
    points
}

/// Points at which steps are halved, and a surrogate is compared with the simulation too: centre, faces and corners,
/// all 3^k of them for up to three axes, else the centre, both ends of every axis and 16 corners.
pub fn step_validation(k: usize) -> Vec<Vec<f64>> {
    if k <= TUNING.few_axes {
        let lattice = TensorGrid::full_factorial(&vec![3; k]);
        return (0..lattice.len()).map(|index| lattice.sample(index)).collect();
    }
    let on_axis = |axis: usize, xi: f64| (0..k).map(|other| if other == axis { xi } else { 0.0 }).collect();
    let mut points = vec![vec![0.0; k]];
    points.extend((0..k).flat_map(|axis| [on_axis(axis, -1.0), on_axis(axis, 1.0)]));
    points.extend(corners(k, TUNING.most_corners));
    points
}

/// Corners at which functions are largest and least by their slopes along the axes from the middle of the box, the
/// farthest first and at most `most`: no sample near the middle shows an effect of one corner alone.
///
/// Functions are given by a scale and by their values at [`step_validation`]; none is asked of up to three axes, all of
/// whose corners are among these.
pub fn corners_by_slopes<'v>(
    k: usize,
    most: usize,
    functions: impl Iterator<Item = (f64, &'v [f64])>,
) -> Vec<Vec<f64>> {
    if k <= TUNING.few_axes {
        return Vec::new();
    }
    let mut reached: BTreeMap<Vec<bool>, f64> = BTreeMap::new();
    for (scale, values) in functions {
        // The middle, then both ends of every axis.
        let slopes: Vec<f64> = values[1..=2 * k].chunks_exact(2).map(|ends| ends[1] - ends[0]).collect();
        let reach = slopes.iter().map(|slope| slope.abs()).sum::<f64>() / scale;
        if reach > 0.0 && reach.is_finite() {
            for is_largest in [false, true] {
                let corner = slopes.iter().map(|slope| (*slope < 0.0) != is_largest).collect();
                let known = reached.entry(corner).or_insert(reach);
                *known = known.max(reach);
            }
        }
    }
    let known: BTreeSet<Vec<bool>> = corners(k, TUNING.most_corners).iter().map(|corner| signs(corner)).collect();
    let mut named: Vec<(Vec<bool>, f64)> = reached.into_iter().filter(|(corner, _)| !known.contains(corner)).collect();
    named.sort_by(|a, b| b.1.total_cmp(&a.1));
    named.truncate(most);
    named.into_iter().map(|(corner, _)| corner.iter().map(|&up| if up { 1.0 } else { -1.0 }).collect()).collect()
}

fn signs(corner: &[f64]) -> Vec<bool> {
    corner.iter().map(|xi| *xi > 0.0).collect()
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
    fn corners_combine_all_ends_of_any_two_axes() {
        for k in [2, 4, 8, 15] {
            let corners = corners(k, 16);
            assert_eq!(corners.len(), 16.min(1 << k));
            for (a, b) in (0..k).flat_map(|a| (0..a).map(move |b| (a, b))) {
                for ends in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
                    assert!(corners.iter().any(|corner| [corner[a], corner[b]] == ends), "{k}: {a}, {b}");
                }
            }
        }
        assert_eq!(corners(0, 16), [Vec::<f64>::new()]);
    }

    #[test]
    fn grid_sizes_of_zero_and_too_many_parameters_are_counted() {
        assert_eq!(TensorGrid::full_factorial(&[]).len(), 1);
        assert_eq!(TensorGrid::full_factorial(&[30; 14]).len(), usize::MAX);
    }

    /// Linear functions in five axes: of 32 corners those of the signs, first of the function with the largest slopes.
    #[test]
    fn slopes_name_corners() {
        let at = |slopes: [f64; 5]| -> Vec<f64> {
            let value = |xi: &Vec<f64>| 7.0 + xi.iter().zip(slopes).map(|(xi, slope)| xi * slope).sum::<f64>();
            step_validation(5).iter().map(value).collect()
        };
        let functions = [at([1e-3, 1e-3, 1e-3, -1e-3, 0.0]), at([1.0, -2.0, 3.0, 4.0, 5.0]), vec![f64::NAN; 27]];
        let named = corners_by_slopes(5, 9, functions.iter().map(|values| (1.0, values.as_slice())));
        let known = corners(5, TUNING.most_corners);
        let wanted = [[-1.0, 1.0, -1.0, -1.0, -1.0], [1.0, -1.0, 1.0, 1.0, 1.0]];
        assert!(wanted.iter().all(|corner| named.contains(&corner.to_vec()) != known.contains(&corner.to_vec())));
        assert!(named.iter().all(|corner| !known.contains(corner)), "{named:?}");
        assert!(named.contains(&vec![1.0, 1.0, 1.0, -1.0, 1.0]) != known.contains(&vec![1.0, 1.0, 1.0, -1.0, 1.0]));
        assert_eq!(corners_by_slopes(5, 1, functions.iter().map(|values| (1.0, values.as_slice()))).len(), 1);
        assert!(corners_by_slopes(3, 9, [(1.0, &[0.0; 27][..])].into_iter()).is_empty());
    }
}
