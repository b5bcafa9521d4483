//! Sparse grids: samples in [−1, 1]^k that grow where the response needs them.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet;

use super::leja::node;
use super::tuning::TUNING;

/// Nested nodes for a downward-closed set of *indices*: a level for each parameter, and with it every index that is
/// nowhere higher. Each index brings one node and one term, the product of Chebyshev polynomials of its levels'
/// degrees.
///
/// Nodes are numbered in the order in which they come, so that values at earlier ones keep their indices while the set
/// grows. Node 0 is the middle of the box.
#[derive(Clone, Debug)]
pub struct SparseGrid {
    /// Highest level allowed along each axis.
    caps: Vec<u8>,
    /// Levels of every index, one after the other.
    levels: Vec<u8>,
    known: FxHashSet<Vec<u8>>,
}

/// Size that is expected of an index: the least that follows from the indices before it, as for a power of Σ aᵢ ξᵢ,
/// where from ξ^(l − eᵢ) to ξ^l the multinomial coefficient times the weights changes by aᵢ |l|/lᵢ. `share` is aᵢ,
/// `size` that of an index before; infinite if none of these is known. Where every other degree may be missing, the
/// index before is the larger one of two (`back`), else the next one.
pub fn expected(levels: &[u8], back: u8, share: impl Fn(usize) -> f64, size: impl Fn(&[u8]) -> Option<f64>) -> f64 {
    let degree: f64 = levels.iter().map(|&level| f64::from(level)).sum();
    let from = |axis: usize| {
        let mut before = levels.to_vec();
        let mut sizes = (0..back.min(levels[axis])).filter_map(|_| {
            before[axis] -= 1;
            size(&before)
        });
        let first = sizes.next()?;
        Some(sizes.fold(first, f64::max) * share(axis) * degree / f64::from(levels[axis]))
    };
    (0..levels.len()).filter(|&axis| levels[axis] > 0).filter_map(from).fold(f64::INFINITY, f64::min)
}

impl SparseGrid {
    /// The middle of the box alone, to grow up to `caps[i]` along axis i. Levels above 128 are never reached.
    pub fn new(caps: &[u8]) -> Self {
        let caps: Vec<u8> = caps.iter().map(|&cap| cap.min(TUNING.max_level)).collect();
        let mut grid = Self { levels: Vec::new(), known: FxHashSet::default(), caps };
        grid.add(&vec![0; grid.dimension()]);
        grid
    }

    /// All indices whose levels, each as a share of its order, add up to one at most: of equal orders, all of that
    /// total degree. `None` if they are more than `most`.
    pub fn simplex(orders: &[usize], most: usize) -> Option<Self> {
        let mut grid =
            Self::new(&orders.iter().map(|&order| u8::try_from(order).unwrap_or(u8::MAX)).collect::<Vec<_>>());
        let mut next = vec![0; orders.len()];
        let share =
            |levels: &[u8]| levels.iter().zip(orders).map(|(l, o)| f64::from(*l) / (*o).max(1) as f64).sum::<f64>();
        // Lexicographic order: every smaller index comes first. Beyond the sum an axis begins anew.
        let mut axis = orders.len();
        while let Some(raised) = axis.checked_sub(1) {
            next[raised] += 1;
            next[raised + 1..].fill(0);
            if next[raised] > grid.caps[raised] || share(&next) > 1.0 + TUNING.rounding_of_shares {
                next[raised] = 0;
                axis = raised;
                continue;
            }
            if grid.len() == most {
                return None;
            }
            grid.add(&next);
            axis = orders.len();
        }
        Some(grid)
    }

    /// The full tensor grid of the given levels, which are its caps too.
    #[cfg(test)]
    pub fn tensor(levels: &[u8]) -> Self {
        let mut grid = Self::new(levels);
        let mut next = vec![0; levels.len()];
        // All levels in lexicographic order: every smaller index comes first.
        while let Some(axis) = (0..next.len()).rev().find(|&axis| next[axis] < grid.caps[axis]) {
            next[axis] += 1;
            next[axis + 1..].fill(0);
            grid.add(&next);
        }
        grid
    }

    /// Number of axes, k.
    pub fn dimension(&self) -> usize {
        self.caps.len()
    }

    /// Number of nodes.
    #[allow(clippy::len_without_is_empty)] // the middle is always there
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// The coordinates of a node.
    pub fn sample(&self, index: usize) -> Vec<f64> {
        self.levels(index).iter().map(|&level| node(level)).collect()
    }

    /// Level along each axis of the index that brought a node, which are the degrees of its term.
    pub fn levels(&self, index: usize) -> &[u8] {
        &self.levels[index * self.dimension()..][..self.dimension()]
    }

    /// Whether an index is in the set.
    pub fn contains(&self, levels: &[u8]) -> bool {
        self.known.contains(levels)
    }

    /// Indices that could be added next: not in the set, no higher than the caps, with all that are smaller in it. In
    /// lexicographic order.
    pub fn candidates(&self) -> Vec<Vec<u8>> {
        let mut found = BTreeSet::new();
        for index in 0..self.len() {
            for axis in 0..self.dimension() {
                let mut levels = self.levels(index).to_vec();
                levels[axis] += 1;
                if levels[axis] <= self.caps[axis] && !self.contains(&levels) && self.is_closed_with(&levels) {
                    found.insert(levels);
                }
            }
        }
        found.into_iter().collect()
    }

    /// Whether the set stays downward closed with an index.
    fn is_closed_with(&self, levels: &[u8]) -> bool {
        let mut smaller = levels.to_vec();
        (0..levels.len()).filter(|&axis| levels[axis] > 0).all(|axis| {
            smaller[axis] -= 1;
            let known = self.contains(&smaller);
            smaller[axis] += 1;
            known
        })
    }

    /// Adds an index; its node is the last then.
    ///
    /// # Panics
    /// If the index is in the set, above a cap, or has a smaller one that is not in the set.
    pub fn add(&mut self, levels: &[u8]) {
        assert_eq!(levels.len(), self.dimension(), "an index of another dimension");
        assert!(levels.iter().zip(&self.caps).all(|(level, cap)| level <= cap), "{levels:?} is above the caps");
        assert!(self.is_closed_with(levels), "the set would not be downward closed with {levels:?}");
        assert!(self.known.insert(levels.to_vec()), "{levels:?} is in the set");
        self.levels.extend_from_slice(levels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn tensor_grid_has_each_combination_once() {
        let grid = SparseGrid::tensor(&[4, 0, 2]);
        assert_eq!(grid.len(), 15);
        let mut nodes: Vec<Vec<f64>> = (0..15).map(|index| grid.sample(index)).collect();
        assert_eq!(nodes[0], [0.0; 3]);
        nodes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        nodes.dedup();
        assert_eq!(nodes.len(), 15);
        assert!(nodes.iter().all(|node| node[1] == 0.0 && [-1.0, 0.0, 1.0].contains(&node[2])));
        assert!(grid.candidates().is_empty());
    }

    #[test]
    fn simplex_grid_has_all_levels_of_a_total_degree() {
        // C(14 + 2, 2), and of two orders those under a line.
        assert_eq!(SparseGrid::simplex(&[2; 14], 1000).map(|grid| grid.len()), Some(120));
        assert!(SparseGrid::simplex(&[2; 14], 119).is_none());
        let grid = SparseGrid::simplex(&[4, 2], 100).unwrap();
        let levels: Vec<&[u8]> = (0..grid.len()).map(|index| grid.levels(index)).collect();
        assert_eq!(levels, [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [2, 0], [2, 1], [3, 0], [4, 0]]);
        assert_eq!(SparseGrid::simplex(&[], 1).map(|grid| grid.len()), Some(1));
    }

    #[test]
    fn candidates_keep_the_grid_downward_closed() {
        let mut grid = SparseGrid::new(&[2, 1]);
        assert_eq!(grid.candidates(), [[0, 1], [1, 0]]);
        grid.add(&[1, 0]);
        assert_eq!(grid.candidates(), [[0, 1], [2, 0]]);
        grid.add(&[0, 1]);
        assert_eq!(grid.candidates(), [[1, 1], [2, 0]]);
        assert_eq!(grid.sample(2), [0.0, 1.0]);
    }

    proptest! {
        #[test]
        fn growing_keeps_the_nodes(choices in prop::collection::vec(0..1000_usize, 1..30)) {
            let mut grid = SparseGrid::new(&[4, 3, 2]);
            for choice in choices {
                let before: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
                let candidates = grid.candidates();
                let Some(levels) = candidates.get(choice % candidates.len().max(1)) else { break };
                grid.add(levels);
                prop_assert_eq!(grid.len(), before.len() + 1);
                for (index, node) in before.iter().enumerate() {
                    prop_assert_eq!(&grid.sample(index), node);
                }
            }
        }
    }
}
