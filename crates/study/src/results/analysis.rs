//! Results of analyses other than a motion, in addition to bounds over time.

use serde::Serialize;

use super::OutputBounds;
use crate::grammar::display_unit::DisplayUnit;

/// Kind of analysis, with its result for the nominal configuration.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AnalysisSummary {
    /// `motion`, `statics`, `kinematics` or `modes`.
    pub kind: String,
    /// At an equilibrium: the smallest eigenvalue of its stiffness about its masses, rad²/s²; `null` if nothing can
    /// move.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stability: Option<f64>,
    /// Largest growth of any mode with states at the nominal parameters, 1/s; negative if all decay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
    /// The same over the box: the largest upper bound of any method.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_growth: Option<f64>,
    /// Coordinates that may have any value at the equilibrium.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub indifferent: Vec<String>,
    /// Bounds of the outputs, if there is one configuration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<ValueSummary>,
}

/// An output of one configuration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ValueSummary {
    /// Its name.
    pub output: String,
    /// SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// With every parameter at its nominal value.
    pub nominal: f64,
    /// By every method: its name, lower and upper bound, and error.
    pub bounds: Vec<(String, f64, f64, f64)>,
}

impl ValueSummary {
    /// Summary of an output that has one time only.
    pub fn of(output: &OutputBounds) -> Self {
        let first = |values: &[f64]| values.first().copied().unwrap_or(f64::NAN);
        let bounds = output.bands.iter().map(|band| {
            let error = first(&band.error.total);
            (band.method.name().to_owned(), first(&band.lower), first(&band.upper), error)
        });
        Self {
            output: output.name.clone(),
            unit: output.unit.clone(),
            display: output.display.clone(),
            nominal: first(&output.nominal),
            bounds: bounds.collect(),
        }
    }
}
