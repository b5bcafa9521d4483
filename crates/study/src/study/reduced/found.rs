//! Results of reduced outputs and requirements.

use super::kept::KeptReduced;
use crate::results::{MethodSummary, ReducedSummary, RequirementSummary};

/// Results of reduced outputs and requirements.
#[derive(Default)]
pub struct Found {
    pub reduced: Vec<ReducedSummary>,
    pub requirements: Vec<RequirementSummary>,
    /// Cost besides the samples of the outputs.
    pub summary: Option<MethodSummary>,
    /// Where surrogates are kept.
    pub kept: Option<KeptReduced>,
}
