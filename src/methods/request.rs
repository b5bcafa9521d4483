//! Limits of what bounds may take, and what is common to the methods' requests.

use super::BoundsRequest;

/// Simulations that one method may ask for.
pub const MOST_SIMULATIONS: f64 = 1e7;

/// Where the search for bounds within a tolerance ends at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Simulations.
    pub solves: usize,
    /// s
    pub seconds: Option<f64>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { solves: 3000, seconds: None }
    }
}

impl BoundsRequest {
    /// Error relative to the output's range that is aimed at where a degree is to be chosen and no tolerance is given.
    pub const TOLERANCE: f64 = 1e-3;
}

/// Keeps the entries of some parameters.
pub(super) fn pick(list: &mut Vec<usize>, kept: &[usize]) {
    *list = kept.iter().filter_map(|&number| list.get(number)).copied().collect();
}
