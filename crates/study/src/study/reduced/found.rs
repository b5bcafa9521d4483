//! Results of reduced outputs and requirements.

use super::kept::KeptReduced;
use crate::model::{Description, Requirement};
use crate::results::{MethodSummary, ReducedSummary, RequirementSummary, Verdict};

/// Results of reduced outputs and requirements.
#[derive(Default)]
pub struct Found {
    pub reduced: Vec<ReducedSummary>,
    pub requirements: Vec<RequirementSummary>,
    /// Cost besides the samples of the outputs.
    pub summary: Option<MethodSummary>,
    /// Stored surrogates, if requested.
    pub kept: Option<KeptReduced>,
}

impl Found {
    /// Result of a study that did not end: every requirement is undecided.
    pub fn nothing(description: &Description) -> Self {
        let undecided = |own: &Requirement| RequirementSummary {
            name: own.name.clone(),
            text: own.text.clone(),
            unit: own.unit.clone(),
            display: own.display.clone(),
            verdict: Verdict::Undecided,
            certified: false,
            margin: f64::NAN,
            percent: None,
            error: f64::NAN,
            surrogate: f64::NAN,
            time: f64::NAN,
            method: "nominal".to_owned(),
            nearest: None,
            decides: Some("a run that ends".to_owned()),
            limits: Vec::new(),
        };
        Self { requirements: description.requirements.iter().map(undecided).collect(), ..Self::default() }
    }
}
