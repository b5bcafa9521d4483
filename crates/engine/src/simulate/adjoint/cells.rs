//! Functions of the time as numbers over cells, lane by lane: values of inputs in a cell, and their adjoints.

use super::tuning::TUNING;

/// Functions of the time for gradients, each with its own.
#[derive(Clone, Copy, Debug)]
pub struct CellFunctions<'f> {
    /// Times at which cells end, s, ascending. Every step lies in one cell.
    pub ends: &'f [f64],
    /// Inputs (two an excitation: level and slope) of each gradient, cell by cell.
    pub values: &'f [Vec<f64>],
}

/// Functions of the lanes of a tile.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct TileInputs {
    ends: Vec<f64>,
    /// Values by cell and input, lane by lane.
    values: Vec<f64>,
    /// Values of a cell.
    size: usize,
}

impl TileInputs {
    /// Functions of some gradients, one a lane.
    pub fn of(functions: &CellFunctions<'_>, lanes: &[usize]) -> Self {
        let cells = functions.ends.len();
        let inputs = functions.values.first().map_or(0, |values| values.len() / cells.max(1));
        let mut values = Vec::with_capacity(cells * inputs * lanes.len());
        for number in 0..cells * inputs {
            values.extend(lanes.iter().map(|&lane| functions.values[lane][number]));
        }
        Self { ends: functions.ends.to_vec(), values, size: inputs * lanes.len() }
    }

    /// The cell of a step that ends at a time, s.
    pub fn cell(&self, end: f64) -> usize {
        self.ends.partition_point(|own| *own < end * (1.0 - TUNING.same_cells)).min(self.ends.len().saturating_sub(1))
    }

    /// The inputs in a cell.
    pub fn values(&self, cell: usize) -> &[f64] {
        &self.values[cell * self.size..][..self.size]
    }

    /// Whether a cell begins with the step that ends at `end`, after the step that ended at `before`, if there was one.
    pub fn begins(&self, end: f64, before: Option<f64>) -> bool {
        before.is_none_or(|before| self.cell(before) != self.cell(end))
    }

    /// Adjoints, all zero.
    pub fn kernel(&self) -> TileKernel {
        TileKernel { adjoints: vec![0.0; self.values.len()], size: self.size }
    }
}

/// Adjoints of the functions of a tile, by cell and input, lane by lane.
#[derive(Clone, Debug, Default)]
pub(in crate::simulate) struct TileKernel {
    adjoints: Vec<f64>,
    size: usize,
}

impl TileKernel {
    /// Adds those of a cell.
    pub fn add(&mut self, cell: usize, adjoints: &[f64]) {
        super::add(&mut self.adjoints[cell * self.size..][..self.size], 1.0, adjoints);
    }

    /// Adds another one.
    pub fn merge(&mut self, other: &Self) {
        super::add(&mut self.adjoints, 1.0, &other.adjoints);
    }

    /// Adjoints of one lane of `width`, by cell and input.
    pub fn of_lane(&self, lane: usize, width: usize) -> Vec<f64> {
        self.adjoints.iter().skip(lane).step_by(width).copied().collect()
    }
}
