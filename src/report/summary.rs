//! `summary.json`: what was run, and what it took.

use serde::Serialize;

/// What a run did; serialised as it stands. Holds nothing that differs between two runs of one command, except
/// `seconds`, which are there only when asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Summary {
    pub model: String,
    pub mbint: String,
    pub coordinates: usize,
    pub constraints: usize,
    pub degrees_of_freedom: usize,
    /// Names of constraints that others imply.
    pub redundant_constraints: Vec<String>,
    pub alpha: f64,
    pub duration: f64,
    pub parameters: Vec<ParameterSummary>,
    pub methods: Vec<MethodSummary>,
    /// Set when the run stopped early: what happened, and up to which time results were kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl Summary {
    /// The same without what differs from run to run.
    #[must_use]
    pub fn without_seconds(&self) -> Self {
        let mut summary = self.clone();
        summary.methods.iter_mut().for_each(|method| method.seconds = None);
        summary
    }
}

/// An uncertain parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct ParameterSummary {
    pub name: String,
    pub unit: String,
    pub nominal: f64,
    pub lower: f64,
    pub upper: f64,
}

/// What a method took. `method` is `nominal`, `chebyshev`, `taylor`, `scan` or `certified`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct MethodSummary {
    pub method: String,
    pub solves: usize,
    pub steps: usize,
    pub newton_iterations: u64,
    /// Steps that fell back to the dense rank-revealing solve.
    pub rank_revealing_solves: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}
