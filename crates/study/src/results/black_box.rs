//! Findings of a run about a program that answers in place of a mechanism.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

/// A program, and how far its answers are to be trusted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlackBoxSummary {
    /// The program and its arguments.
    pub command: Vec<String>,
    /// Number of points that were asked twice.
    pub repeated: usize,
    /// Outputs whose answers differed there; none if all were the same.
    pub noise: Vec<NoiseSummary>,
    /// The parameter by which the error of the program's own steps was found; without one, no error includes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refined_by: Option<String>,
}

/// How much an output differs between two answers to the same point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoiseSummary {
    /// Name of the output.
    pub output: String,
    /// Its SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Largest difference of any row.
    pub noise: f64,
}
