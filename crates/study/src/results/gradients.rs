//! Derivatives of outputs by parameters.

use serde::Serialize;

use crate::grammar::display_unit::{DisplayUnit, ShownUnit};

/// A parameter by which outputs are differentiated.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GradientParameter {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
    /// Value at which the derivatives are taken, SI.
    pub value: f64,
    /// Half the width of its interval, SI.
    pub half_width: f64,
}

/// An output's derivatives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputGradients {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
    /// Its values over the times, SI.
    pub values: Vec<f64>,
    /// For each time its derivatives by the parameters, SI; zero for parameters on which it does not depend, not finite
    /// if undefined.
    pub by_parameters: Vec<Vec<f64>>,
}

impl OutputGradients {
    /// Influence of all parameters on the output at a time: Σ |∂/∂p| times half widths.
    pub fn reach(&self, row: usize, parameters: &[GradientParameter]) -> f64 {
        let terms = self.by_parameters[row].iter().zip(parameters);
        terms.map(|(by, parameter)| (by * parameter.half_width).abs()).sum()
    }

    /// The time of the largest [`reach`](Self::reach); the last if it is known at no time.
    pub fn most_sensitive(&self, parameters: &[GradientParameter]) -> usize {
        let reaches = (0..self.values.len()).map(|row| (row, self.reach(row, parameters)));
        let most = reaches.filter(|(_, reach)| reach.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1));
        most.map_or(self.values.len().saturating_sub(1), |(row, _)| row)
    }
}

/// The derivatives of a number by the parameters.
#[derive(Clone, Copy, Debug)]
pub struct DerivativesAt<'a> {
    /// Name in the model.
    pub name: &'a str,
    /// The unit in which people see it.
    pub unit: ShownUnit<'a>,
    /// Its value, SI.
    pub value: f64,
    /// The instant of it, s.
    pub time: Option<f64>,
    /// Whether it is the margin of a requirement.
    pub is_margin: bool,
    /// SI.
    pub by_parameters: &'a [f64],
}

impl OutputGradients {
    /// The output at a row.
    pub fn at<'a>(&'a self, times: &[f64], row: usize) -> DerivativesAt<'a> {
        DerivativesAt {
            name: &self.name,
            unit: ShownUnit::of(&self.display, &self.unit),
            value: self.values[row],
            time: Some(times[row]),
            is_margin: false,
            by_parameters: &self.by_parameters[row],
        }
    }
}

impl ReducedGradients {
    /// The number.
    pub fn at(&self) -> DerivativesAt<'_> {
        let Self { name, value, time, is_margin, by_parameters, .. } = self;
        let unit = ShownUnit::of(&self.display, &self.unit);
        DerivativesAt { name, unit, value: *value, time: *time, is_margin: *is_margin, by_parameters }
    }
}

/// Derivatives of a model's outputs by its uncertain parameters, at one point of the box.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gradients {
    /// Name of the model.
    pub model: String,
    /// s
    pub times: Vec<f64>,
    /// The uncertain parameters.
    pub parameters: Vec<GradientParameter>,
    /// The outputs.
    pub outputs: Vec<OutputGradients>,
    /// Reduced outputs and requirements' margins, as far as they follow from the motion and have derivatives.
    pub reduced: Vec<ReducedGradients>,
    /// Time from which derivatives depend on the steps, s: equations switch within these, and the motion cannot be
    /// followed from event to event.
    pub unreliable_from: Option<f64>,
}

/// Derivatives of a reduced output, or of a requirement's margin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReducedGradients {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
    /// Whether it is the margin of a requirement.
    pub is_margin: bool,
    /// Its value, SI.
    pub value: f64,
    /// The instant that decides it, s; `None` if more than one does.
    pub time: Option<f64>,
    /// Derivatives by the parameters, SI.
    pub by_parameters: Vec<f64>,
}
