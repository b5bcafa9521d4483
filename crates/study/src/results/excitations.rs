//! Effect on outputs of excitations of which only limits are known, as constants and as functions of the time.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

/// Displacement of an output by excitations: half of the largest width of its bounds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExcitationSummary {
    /// Name of the output.
    pub output: String,
    /// Its SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
    /// With excitations that are constants, SI.
    pub as_constant: f64,
    /// With excitations that are any functions, SI.
    pub as_function: f64,
    /// When the function in the witness' file moves it the most, s.
    pub time: f64,
    /// The output then, SI.
    pub value: f64,
}

/// The functions under which an output or a reduced output goes the furthest, or under which a requirement fails.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionWitness {
    /// Its name.
    pub name: String,
    /// Its SI unit; that of the margin of a requirement.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    pub display: Option<DisplayUnit>,
    /// Number of the output; `None` of reduced outputs and requirements.
    pub output: Option<usize>,
    /// When it is there, s; `None` without an instant.
    pub time: Option<f64>,
    /// The output there, or the margin, SI.
    pub value: f64,
    /// All uncertain parameters, SI.
    pub parameters: Vec<f64>,
    /// The excitations.
    pub functions: Vec<WitnessFunction>,
}

/// An excitation's function: straight lines from point to point. Where it jumps, two points are close.
#[derive(Clone, Debug, PartialEq)]
pub struct WitnessFunction {
    /// Name of the excitation.
    pub name: String,
    /// Times (s) and values (SI), times ascending.
    pub points: Vec<(f64, f64)>,
}
