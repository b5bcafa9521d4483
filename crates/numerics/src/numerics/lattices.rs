//! Lattices with the points that check them, made once for all functions that are evaluated there.

use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::FxHashMap;

use super::lattice::Lattice;
use super::samples::spread;
use super::tuning::TUNING;

/// Lattices that were used, by their intervals along each axis; results do not depend on which are stored.
#[derive(Debug, Default)]
pub struct Lattices(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    lattices: FxHashMap<Vec<usize>, Arc<CheckedLattice>>,
    /// Points of all of them.
    points: usize,
}

/// A lattice, and points of a low-discrepancy sequence that have nothing to do with it.
#[derive(Debug)]
pub(super) struct CheckedLattice {
    pub lattice: Lattice,
    /// Number of the lattice's points.
    pub count: usize,
    /// ξ of these, and then of those of the check.
    pub points: Vec<Vec<f64>>,
}

impl CheckedLattice {
    fn new(intervals: &[usize]) -> Self {
        let lattice = Lattice::new(intervals);
        let mut points = lattice.points();
        let count = points.len();
        let checks =
            if intervals.is_empty() { 0 } else { (count / TUNING.lattice_points_a_check).max(TUNING.least_checks) };
        points.extend(spread(intervals.len(), checks));
        Self { lattice, count, points }
    }
}

impl Lattices {
    /// The lattice with `intervals[i]` intervals along axis i.
    pub(super) fn of(&self, intervals: &[usize]) -> Arc<CheckedLattice> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = kept.lattices.get(intervals) {
            return Arc::clone(known);
        }
        let made = Arc::new(CheckedLattice::new(intervals));
        if kept.points + made.points.len() > TUNING.kept_points {
            *kept = Kept::default();
        }
        kept.points += made.points.len();
        kept.lattices.insert(intervals.to_vec(), Arc::clone(&made));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_is_made_once_and_memory_is_bounded() {
        let lattices = Lattices::default();
        let first = lattices.of(&[8, 6]);
        assert_eq!((first.count, first.points.len()), (63, 63 + 15));
        assert!(Arc::ptr_eq(&first, &lattices.of(&[8, 6])));
        for intervals in 1..400 {
            lattices.of(&[intervals, intervals]);
            assert!(lattices.0.lock().unwrap().points <= TUNING.kept_points.max(401 * 401 * 5 / 4));
        }
        assert!(!Arc::ptr_eq(&first, &lattices.of(&[8, 6])));
    }
}
