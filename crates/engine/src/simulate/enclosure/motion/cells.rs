//! Cells that are proven, and whether others would be better.

use symdiff::Interval;

use super::approximation::Approximation;
use super::proof::Proven;
use super::tuning::TUNING;
use crate::certificate::frame::Frame;
use crate::certificate::spaces::Cell;

/// A cell that is proven.
#[derive(Debug)]
pub(super) struct Passed {
    pub cell: Cell,
    pub approximation: Approximation,
    pub proven: Proven,
    /// The frame at the cell's start.
    pub frame: Frame,
    /// Outputs over the cell.
    pub ranges: Vec<Interval>,
}

/// A proven cell, and the start of the cell after it.
pub(super) struct Next {
    pub cell: Cell,
    pub approximation: Approximation,
    pub proven: Proven,
    /// The approximation at the cell's end.
    pub end: Approximation,
    /// The frame at the cell's end.
    pub frame: Frame,
    /// Models of the outputs over the cell, one after the other.
    pub outputs: Vec<f64>,
    /// Defect of the accelerations, relative to their size.
    pub defect: f64,
    /// Whether that is so large that a knot must be in the cell. Much shorter cells may be better then even if one of
    /// half the length is not: where the knot lies decides. Without a knot, halving that does not help shows that the
    /// defect is of the parameters, not of the time.
    pub passes_knot: bool,
    /// Last terms of the accelerations with a power of τ, relative to their size: over this cell, over half of it, and
    /// over twice its length.
    pub tails: [f64; 3],
    /// Factor by which errors make the distance larger.
    pub gain: f64,
}

impl Next {
    /// Whether shorter cells may be better.
    pub fn is_long(&self) -> bool {
        self.is_coarse() || self.gain > TUNING.large_gain
    }

    /// Whether a shorter cell has a smaller defect, and needs it.
    fn is_coarse(&self) -> bool {
        let falls = self.tails[0] > TUNING.small_defect && self.tails[1] < 0.1 * self.tails[0];
        self.passes_knot || (self.defect > TUNING.large_defect && falls)
    }

    /// Whether two cells of half the length are better than one.
    pub fn is_better_than(&self, larger: &Self) -> bool {
        let by_defect = larger.is_coarse() && self.defect < 0.7 * larger.defect;
        by_defect || (larger.gain > TUNING.large_gain && self.gain - 1.0 < TUNING.helpful_halving * (larger.gain - 1.0))
    }

    /// Whether a cell of twice the length is not coarse, by the polynomials.
    pub fn may_be_doubled(&self) -> bool {
        let is_fine = self.tails[2] < TUNING.small_defect || self.tails[2] < 10.0 * self.tails[0];
        is_fine && self.gain < TUNING.small_gain
    }
}
