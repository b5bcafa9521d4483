//! Margins of requirements over the widest box, each in multiples of its nominal one.

use crate::methods::MOST_ON_GRIDS;
use crate::numerics::{PointSet, Points};
use crate::study::reduced::Margins;

use super::items::Item;
use super::tuning::TUNING;

/// Margins as functions of the parameters.
pub struct Surface<'k> {
    kept: Margins<'k>,
    pub items: &'k [Item],
    /// Number of margins.
    pub count: usize,
    /// Nominal margins, in their units.
    pub nominal: Vec<f64>,
    /// Correction subtracted from each margin, in its unit: the surrogate's uncertainty.
    pub reserves: Vec<f64>,
}

impl<'k> Surface<'k> {
    /// Margins of all requirements, with the surrogate's errors in reserve. With many parameters these errors are those
    /// of corners that no box comes near in which the requirements hold: there the studies that confirm a choice
    /// correct them.
    pub fn new(kept: Margins<'k>, items: &'k [Item]) -> Self {
        let count = kept.count();
        let mut surface = Self { kept, items, count, nominal: vec![1.0; count], reserves: vec![0.0; count] };
        let nominal: Vec<f64> = items.iter().map(|item| item.nominal).collect();
        surface.nominal = surface.raw(PointSet::of(&[nominal]).points());
        if surface.has_errors() {
            surface.reserves = (0..count).map(|index| surface.error(index)).collect();
        }
        surface
    }

    /// Whether errors of margins are of boxes that may be chosen.
    pub fn has_errors(&self) -> bool {
        self.items.len() <= MOST_ON_GRIDS
    }

    /// Error of a margin; unknown if it cannot be relied on.
    pub fn error(&self, requirement: usize) -> f64 {
        self.kept.error(requirement)
    }

    /// The part of a margin's error that a better surrogate would not have.
    pub fn surrogate_error(&self, requirement: usize) -> f64 {
        self.kept.surrogate_error(requirement)
    }

    /// The size of a margin with which others are compared: its unit, if nothing is left of it at the nominal values.
    pub fn scale(&self, requirement: usize) -> f64 {
        let nominal = self.nominal[requirement].abs();
        if nominal > f64::MIN_POSITIVE { nominal } else { 1.0 }
    }

    /// Margins in their units, requirement by requirement.
    pub fn raw(&self, samples: Points) -> Vec<f64> {
        self.kept.values(samples)
    }

    /// Remaining margins of samples, in multiples of the nominal ones, requirement by requirement.
    pub fn slacks(&self, samples: Points) -> Vec<f64> {
        let mut slacks = self.raw(samples);
        for (requirement, own) in slacks.chunks_exact_mut(samples.len().max(1)).enumerate() {
            let (reserve, scale) = (self.reserves[requirement], self.scale(requirement));
            for slack in own {
                *slack = if slack.is_nan() { TUNING.unknown_margin } else { (*slack - reserve) / scale };
            }
        }
        slacks
    }

    /// The same at points ξ of the box with these multiples of the tolerances.
    pub fn slacks_at<'p>(&self, multiples: &[f64], points: impl ExactSizeIterator<Item = &'p [f64]>) -> Vec<f64> {
        let along = |xi: &[f64], axis: usize| self.value(axis, multiples[axis], xi[axis]);
        self.slacks(PointSet::mapped(points, multiples.len(), along).points())
    }

    /// The sample at ξ of the box with these multiples of the tolerances.
    pub fn sample(&self, multiples: &[f64], xi: &[f64]) -> Vec<f64> {
        (0..xi.len()).map(|axis| self.value(axis, multiples[axis], xi[axis])).collect()
    }

    /// A parameter at its ξ with a multiple of its tolerance.
    fn value(&self, axis: usize, multiple: f64, xi: f64) -> f64 {
        let item = &self.items[axis];
        let side = if xi < 0.0 { item.below } else { item.above };
        item.nominal + multiple * xi * side
    }
}
