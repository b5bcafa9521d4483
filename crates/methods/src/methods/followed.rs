//! Ends of outputs that were followed along gradients of the simulations themselves: bounds of many parameters, for
//! which a polynomial over the whole box would take too many samples.

use super::kept::KeptSurrogate;
use crate::numerics::Range;

/// Contributions of the parameters to an output's spread in one row.
#[derive(Clone, Debug)]
pub struct Sensitivity {
    /// First-order Sobol indices: each parameter's share of the variance, alone.
    pub main: Vec<f64>,
    /// Total Sobol indices: the same together with others.
    pub total: Vec<f64>,
    /// Width of the range if a parameter were at its nominal value.
    pub width_without: Vec<f64>,
}

/// An output's ends in one row.
#[derive(Clone, Debug)]
pub struct Followed {
    /// The range between both ends, which are attained.
    pub range: Range,
    /// Largest distance of the output beyond them.
    pub error: f64,
    /// Sensitivity, if known.
    pub sensitivity: Option<Sensitivity>,
}

/// The ends of all outputs in all rows.
#[derive(Clone, Debug)]
pub struct FollowedEnds {
    /// Ends by row and output.
    ends: Vec<Followed>,
    /// Polynomials of the outputs over the whole box, if they are wanted and known.
    surrogate: Option<KeptSurrogate>,
}

impl FollowedEnds {
    /// Followed ends, by row and output.
    pub fn new(ends: Vec<Followed>, surrogate: Option<KeptSurrogate>) -> Self {
        Self { ends, surrogate }
    }

    /// Polynomials of the outputs over the whole box, if they are wanted and known.
    pub(super) fn surrogate(&self) -> Option<&KeptSurrogate> {
        self.surrogate.as_ref()
    }

    /// Ends by row and output.
    pub(super) fn ends(&self) -> &[Followed] {
        &self.ends
    }
}
