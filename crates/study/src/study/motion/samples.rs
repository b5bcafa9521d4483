//! Samples that show how uncertain a motion is, and samples from which its polynomials are made.

use super::tuning::TUNING;
use crate::numerics::{ParameterBox, Sample, SparseGrid, Surrogate, corners, spread};

/// Samples of a box.
pub(super) struct Samples {
    /// Samples that are shown.
    pub shown: Vec<Sample>,
    /// Surrogate from which polynomials are made; `None` if no parameter is uncertain, or too many are.
    pub surrogate: Option<Surrogate>,
    /// The samples that they are made from.
    pub nodes: Vec<Sample>,
}

impl Samples {
    pub fn of(domain: &ParameterBox) -> Self {
        let k = domain.dimension();
        if k == 0 {
            return Self { shown: Vec::new(), surrogate: None, nodes: Vec::new() };
        }
        let places = corners(k, TUNING.corners).into_iter().chain(spread(k, TUNING.inside));
        let surrogate = (k <= TUNING.most_parameters).then(|| Surrogate::sparse(&grid(k)));
        let nodes = surrogate.iter().flat_map(Surrogate::samples).map(|xi| domain.sample(xi)).collect();
        Self { shown: places.map(|xi| domain.sample(&xi)).collect(), surrogate, nodes }
    }
}

/// All terms of a total degree; for many parameters a parabola in each.
fn grid(k: usize) -> SparseGrid {
    let (degree, together) = TUNING.degrees.get(k).map_or((2, 1), |&degree| (degree, k));
    let allowed = |levels: &[u8]| {
        let total: usize = levels.iter().map(|&level| usize::from(level)).sum();
        total <= degree && levels.iter().filter(|&&level| level > 0).count() <= together
    };
    // Degrees are small numbers.
    let mut grid = SparseGrid::new(&vec![degree as u8; k]);
    loop {
        let candidates: Vec<Vec<u8>> = grid.candidates().into_iter().filter(|levels| allowed(levels)).collect();
        if candidates.is_empty() {
            return grid;
        }
        candidates.iter().for_each(|levels| grid.add(levels));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_all_terms_of_a_degree() {
        assert_eq!([1, 2, 3, 4, 6, 10].map(|k| grid(k).len()), [7, 15, 20, 15, 28, 21]);
    }
}
