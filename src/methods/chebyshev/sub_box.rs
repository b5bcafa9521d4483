//! A box with its sparse grid: what its indices are expected to contribute, and when it is to be split.

use std::borrow::Cow;

use rustc_hash::FxHashMap;

use crate::methods::validation::ValidationTable;
use crate::numerics::{ParameterBox, SparseGrid};

/// Highest degree in a parameter, of 17 nodes; then the box is split.
pub(super) const HIGHEST: u8 = 16;

/// A box is split where the expected surplus of a higher degree than is allowed is so many times the largest allowed one.
const SPLIT: f64 = 4.0;

/// A box with its surrogate.
pub(super) struct SubBox<'r> {
    pub domain: ParameterBox,
    pub grid: SparseGrid,
    /// Motions and outputs at the grid's nodes: so many of them, then row by row, line by line, node by node.
    pub nodes: Vec<(usize, Vec<f64>)>,
    /// Hierarchical surplus of each index of the grid: the error of the surrogate before the index was added.
    pub surplus: FxHashMap<Vec<u8>, f64>,
    /// Values of the validation samples.
    pub direct: Cow<'r, ValidationTable>,
    /// Largest error at those over the one that is allowed.
    pub error: f64,
}

impl SubBox<'_> {
    /// Rows that all nodes have reached.
    pub fn rows(&self, lines: usize) -> usize {
        self.nodes.iter().map(|(count, values)| values.len() / (lines * count)).min().unwrap_or(0)
    }

    /// Motions and outputs of all nodes: row by row, line by line, node by node.
    pub fn motions(&self, lines: usize, rows: impl Iterator<Item = usize>) -> Vec<f64> {
        let mut motions = Vec::new();
        for line in rows.flat_map(|row| row * lines..(row + 1) * lines) {
            for (count, values) in &self.nodes {
                motions.extend_from_slice(&values[line * count..][..*count]);
            }
        }
        motions
    }

    /// Indices with their expected surpluses, the largest first.
    pub fn expected(&self, indices: Vec<Vec<u8>>) -> Vec<(Vec<u8>, f64)> {
        let expect = |levels: Vec<u8>| {
            let expected = self.extrapolated(&levels);
            (levels, expected)
        };
        let mut expected: Vec<(Vec<u8>, f64)> = indices.into_iter().map(expect).collect();
        // Of equals, the first in the alphabet.
        expected.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        expected
    }

    /// The expected surplus of an index: the least that follows from the indices before it, as for a power of Σ aᵢ ξᵢ, where from
    /// ξ^(l − eᵢ) to ξ^l the multinomial coefficient times the weights changes by aᵢ |l|/lᵢ.
    fn extrapolated(&self, levels: &[u8]) -> f64 {
        let k = levels.len();
        let weight = |axis: usize| {
            let mut first = vec![0; k];
            first[axis] = 1;
            self.surplus.get(&first).copied()
        };
        let total: f64 = (0..k).filter_map(weight).sum();
        let degree: f64 = levels.iter().map(|&level| f64::from(level)).sum();
        let from = |axis: usize| {
            let mut before = levels.to_vec();
            before[axis] -= 1;
            let share = weight(axis).map_or(1.0, |weight| if total > 0.0 { weight / total } else { 1.0 });
            self.surplus.get(&before).map(|surplus| surplus * share * degree / f64::from(levels[axis]))
        };
        (0..k).filter(|&axis| levels[axis] > 0).filter_map(from).fold(f64::INFINITY, f64::min)
    }

    /// The axis along which the box is to be split: where its degree is as high as is allowed, and a higher one has a much
    /// larger expected surplus than whatever else can be added.
    pub fn axis_to_split(&self) -> Option<usize> {
        let beyond = |levels: &Vec<u8>| {
            let axis = levels.iter().position(|&level| level == HIGHEST)?;
            let mut higher = levels.clone();
            higher[axis] += 1;
            Some((axis, self.extrapolated(&higher)))
        };
        let most = self.surplus.keys().filter_map(beyond).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let candidates = self.grid.candidates();
        let allowed = candidates.iter().map(|levels| self.extrapolated(levels)).fold(0.0, f64::max);
        match most {
            Some((axis, beyond)) if candidates.is_empty() || beyond > SPLIT * allowed => Some(axis),
            _ => None,
        }
    }
}
