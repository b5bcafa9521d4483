//! The samples of a scan.

use std::iter::StepBy;
use std::ops::Range;

use super::domain::{ParameterBox, Sample};
use super::samples::TensorGrid;
use super::tuning::TUNING;

/// The samples of a scan, in shards of consecutive ones.
#[derive(Clone, Debug)]
pub struct ScanGrid {
    grid: TensorGrid,
    points: Vec<usize>,
    shard: usize,
}

impl ScanGrid {
    /// Fewest samples of a shard, but for the last.
    pub const LEAST_SHARD: usize = TUNING.least_shard;

    /// Grid with `points[i]` points along axis i, both ends included.
    pub fn new(points: &[usize]) -> Self {
        let grid = TensorGrid::full_factorial(points);
        // Slabs of the first axis stay together, so that neighbours do.
        let slab = grid.len() / points.first().copied().unwrap_or(1);
        let shard = slab.saturating_mul(3).clamp(Self::LEAST_SHARD, TUNING.largest_shard);
        Self { grid, points: points.to_vec(), shard }
    }

    /// Points along each axis, the last fastest.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    /// Number of samples.
    #[allow(clippy::len_without_is_empty)] // every axis has a point
    pub fn len(&self) -> usize {
        self.grid.len()
    }

    /// Number of the first sample of each shard.
    pub fn shards(&self) -> StepBy<Range<usize>> {
        (0..self.grid.len()).step_by(self.shard)
    }

    /// The samples of the shard that begins with number `first`.
    pub fn samples(&self, first: usize, domain: &ParameterBox) -> Vec<Sample> {
        let end = (first + self.shard).min(self.grid.len());
        (first..end).map(|index| domain.sample(&self.grid.sample(index))).collect()
    }
}
