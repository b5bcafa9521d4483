//! Sparse grids: samples in [−1, 1]^k that grow where the response needs them.

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::lobatto::{MAX_LEVEL, fresh, node};

/// Nested Chebyshev–Lobatto nodes for a downward-closed set of *indices*: a level (0, 1, 2, 3… with 1, 3, 5, 9… nodes) for
/// each parameter, and with it every index that is nowhere higher.
///
/// An index brings the nodes that no smaller one has. They are numbered in the order in which they come, so that values
/// at earlier nodes keep their places while the set grows. Sample 0 is the middle of the box.
#[derive(Clone, Debug)]
pub struct SparseGrid {
    dimension: usize,
    /// Highest level allowed along each axis.
    caps: Vec<u8>,
    indices: Vec<Index>,
    /// Place of each in `indices`.
    places: FxHashMap<Vec<u8>, usize>,
    /// Number along each axis of every node, node after node.
    numbers: Vec<u8>,
}

/// An index of the set.
#[derive(Clone, Debug)]
struct Index {
    levels: Vec<u8>,
    nodes: Range<usize>,
}

/// An index that may be added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Level along each axis.
    pub levels: Vec<u8>,
    /// Nodes that it would bring.
    pub cost: usize,
}

impl SparseGrid {
    /// The middle of the box alone, to grow up to `caps[i]` along axis i. Levels above 7 (129 nodes) are never reached.
    pub fn new(caps: &[u8]) -> Self {
        let caps: Vec<u8> = caps.iter().map(|&cap| cap.min(MAX_LEVEL)).collect();
        let mut grid =
            Self { dimension: caps.len(), caps, indices: Vec::new(), places: FxHashMap::default(), numbers: Vec::new() };
        grid.add(&vec![0; grid.dimension]);
        grid
    }

    /// The full tensor grid of the given levels, which are its caps too.
    pub fn tensor(levels: &[u8]) -> Self {
        let mut grid = Self::new(levels);
        let mut next = vec![0; grid.dimension];
        // All levels in lexicographic order: every smaller index comes first.
        while let Some(axis) = (0..grid.dimension).rev().find(|&axis| next[axis] < grid.caps[axis]) {
            next[axis] += 1;
            next[axis + 1..].fill(0);
            grid.add(&next);
        }
        grid
    }

    /// Number of axes, k.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of nodes.
    #[allow(clippy::len_without_is_empty)] // the middle is always there
    pub fn len(&self) -> usize {
        self.indices.last().map_or(0, |index| index.nodes.end)
    }

    /// Writes the coordinates of a node; `out` has k entries.
    pub fn fill(&self, index: usize, out: &mut [f64]) {
        out.iter_mut().zip(self.numbers(index)).for_each(|(xi, &number)| *xi = node(number));
    }

    /// The coordinates of a node.
    pub fn sample(&self, index: usize) -> Vec<f64> {
        let mut out = vec![0.0; self.dimension];
        self.fill(index, &mut out);
        out
    }

    /// The set's indices in the order in which they came, each with the nodes that it brought.
    pub fn indices(&self) -> impl ExactSizeIterator<Item = (&[u8], Range<usize>)> {
        self.indices.iter().map(|index| (index.levels.as_slice(), index.nodes.clone()))
    }

    /// Place of an index in [`indices`](Self::indices), if it is in the set.
    pub fn position(&self, levels: &[u8]) -> Option<usize> {
        self.places.get(levels).copied()
    }

    /// Indices that could be added next: not in the set, no higher than the caps, with all that are smaller in it. In
    /// lexicographic order.
    pub fn candidates(&self) -> Vec<Candidate> {
        let mut found = BTreeSet::new();
        for index in &self.indices {
            for axis in 0..self.dimension {
                let mut levels = index.levels.clone();
                levels[axis] += 1;
                if levels[axis] <= self.caps[axis] && self.position(&levels).is_none() && self.admissible(&levels) {
                    found.insert(levels);
                }
            }
        }
        found.into_iter().map(|levels| Candidate { cost: cost(&levels), levels }).collect()
    }

    /// Whether the set stays downward closed with an index.
    fn admissible(&self, levels: &[u8]) -> bool {
        let mut smaller = levels.to_vec();
        (0..self.dimension).filter(|&axis| levels[axis] > 0).all(|axis| {
            smaller[axis] -= 1;
            let known = self.position(&smaller).is_some();
            smaller[axis] += 1;
            known
        })
    }

    /// Adds an index; returns the numbers of its nodes, which are the last.
    ///
    /// # Panics
    /// If the index is in the set, above a cap, or has a smaller one that is not in the set.
    pub fn add(&mut self, levels: &[u8]) -> Range<usize> {
        assert_eq!(levels.len(), self.dimension, "an index of another dimension");
        assert!(levels.iter().zip(&self.caps).all(|(level, cap)| level <= cap), "{levels:?} is above the caps");
        assert!(self.admissible(levels), "the set would not be downward closed with {levels:?}");
        assert!(self.places.insert(levels.to_vec(), self.indices.len()).is_none(), "{levels:?} is in the set");
        let mut number: Vec<u8> = levels.iter().map(|&level| *fresh(level).start()).collect();
        loop {
            self.numbers.extend_from_slice(&number);
            let Some(axis) = (0..self.dimension).rev().find(|&axis| number[axis] < *fresh(levels[axis]).end()) else {
                break;
            };
            number[axis] += 1;
            for (number, &level) in number[axis + 1..].iter_mut().zip(&levels[axis + 1..]) {
                *number = *fresh(level).start();
            }
        }
        let nodes = self.len()..self.len() + cost(levels);
        self.indices.push(Index { levels: levels.to_vec(), nodes: nodes.clone() });
        nodes
    }

    /// Number along each axis of a node, and the degrees of the term that it stands for.
    pub(super) fn numbers(&self, index: usize) -> &[u8] {
        &self.numbers[index * self.dimension..][..self.dimension]
    }
}

/// Nodes that an index brings.
fn cost(levels: &[u8]) -> usize {
    levels.iter().map(|&level| fresh(level).count()).product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_tensor_is_all_combinations_and_each_node_is_there_once() {
        let grid = SparseGrid::tensor(&[2, 0, 1]);
        assert_eq!(grid.len(), 15);
        let mut nodes: Vec<Vec<f64>> = (0..15).map(|index| grid.sample(index)).collect();
        assert_eq!(nodes[0], [0.0; 3]);
        nodes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        nodes.dedup();
        assert_eq!(nodes.len(), 15);
        assert!(nodes.iter().all(|node| node[1] == 0.0 && [-1.0, 0.0, 1.0].contains(&node[2])));
        assert!(grid.candidates().is_empty(), "a tensor has reached its caps");
    }

    #[test]
    fn candidates_have_all_that_is_smaller() {
        let mut grid = SparseGrid::new(&[3, 3]);
        let levels = |grid: &SparseGrid| grid.candidates().into_iter().map(|c| (c.levels, c.cost)).collect::<Vec<_>>();
        assert_eq!(levels(&grid), [(vec![0, 1], 2), (vec![1, 0], 2)]);
        assert_eq!(grid.add(&[1, 0]), 1..3);
        assert_eq!(levels(&grid), [(vec![0, 1], 2), (vec![2, 0], 2)]);
        assert_eq!(grid.add(&[0, 1]), 3..5);
        assert_eq!(levels(&grid), [(vec![0, 2], 2), (vec![1, 1], 4), (vec![2, 0], 2)]);
        assert_eq!((grid.sample(1), grid.sample(4)), (vec![1.0, 0.0], vec![0.0, -1.0]));
    }

    #[test]
    fn without_parameters_there_is_one_node() {
        let grid = SparseGrid::new(&[]);
        assert_eq!((grid.len(), grid.candidates().len(), SparseGrid::tensor(&[]).len()), (1, 0, 1));
    }

    proptest! {
        #[test]
        fn growing_keeps_the_nodes_and_counts_them(choices in prop::collection::vec(0..1000_usize, 1..20)) {
            let mut grid = SparseGrid::new(&[4, 2, 3]);
            for choice in choices {
                let before: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
                let candidates = grid.candidates();
                let Candidate { levels, cost } = &candidates[choice % candidates.len()];
                prop_assert_eq!(grid.add(levels), before.len()..before.len() + cost);
                prop_assert_eq!(grid.len() * 3, grid.numbers.len());
                let kept: Vec<Vec<f64>> = (0..before.len()).map(|index| grid.sample(index)).collect();
                prop_assert_eq!(kept, before);
            }
        }
    }
}
