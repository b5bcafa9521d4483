//! Results of a run: bounds of every output over time.

use std::sync::Arc;

use super::FunctionWitness;
use crate::certificate::Certified;
use crate::grammar::display_unit::DisplayUnit;
use crate::methods::Method;
use crate::model::Analysis;
use crate::numerics::BandError;

/// Bounds of every output of a model at the output times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Output times, s, ascending.
    pub times: Vec<f64>,
    /// In the model's order.
    pub outputs: Vec<OutputBounds>,
    /// Contributions of the parameters, output by output; empty if unknown.
    pub contributions: Vec<Vec<Contribution>>,
    /// Share of the box that the bounds are of, in each row; empty if they are of all of it.
    pub covered: Vec<f64>,
    /// Analysis of the mechanism.
    pub analysis: Analysis,
    /// Frequency responses, frequency by frequency.
    pub responses: Vec<ResponsePoint>,
    /// Samples at which outputs are least and largest, if they were searched for.
    pub witnesses: Vec<Witness>,
    /// Derivatives at the nominal parameters, if they were asked for.
    pub derivatives: Vec<OutputDerivatives>,
    /// Functions of excitations under which outputs go the furthest, if something is excited.
    pub functions: Vec<FunctionWitness>,
    /// Proofs of subsystems, for a certificate.
    pub certified: Vec<Arc<Certified>>,
}

/// A simulated sample at which an output is the least or the largest in a row of all that were simulated in the search
/// for its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// Number of the row.
    pub row: usize,
    /// Number of the output.
    pub output: usize,
    /// Whether it is the largest value.
    pub is_upper: bool,
    /// The value, SI.
    pub value: f64,
    /// All uncertain parameters, SI.
    pub parameters: Vec<f64>,
}

impl Bounds {
    /// Whether there is one configuration, not many over time.
    pub fn is_of_one_configuration(&self) -> bool {
        self.analysis.visits() && self.times.len() == 1
    }
}

/// An output's derivatives by the uncertain parameters, at their nominal values.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputDerivatives {
    /// Number of the output.
    pub output: usize,
    /// (row, parameter), SI; NaN from the row on in which they cannot be trusted.
    pub by_parameters: Vec<f64>,
}

/// A parameter's part in the spread of an output over the times; NaN if unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Contribution {
    /// Its name.
    pub parameter: String,
    /// Share of the variance (every parameter spread evenly over its interval) that is its alone.
    pub main: Vec<f64>,
    /// The same with the share it has in interactions.
    pub total: Vec<f64>,
    /// Width of the output's range if this parameter were at its nominal value.
    pub width_without: Vec<f64>,
}

/// One output's nominal course and its bands; each vector runs over the times.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputBounds {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one; the numbers here are in SI.
    pub display: Option<DisplayUnit>,
    /// With every parameter at its nominal value.
    pub nominal: Vec<f64>,
    /// In the order of [`Method`].
    pub bands: Vec<Band>,
}

/// Response of an output to a harmonic load of size one at one frequency; vectors run over the times.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponsePoint {
    /// Name of the response in the model.
    pub name: String,
    /// Hz
    pub frequency: f64,
    /// In the output's unit over that of the load.
    pub amplitude: OutputBounds,
    /// Phase of the output relative to the load, rad; negative if the output lags.
    pub phase: OutputBounds,
    /// Contributions of the parameters to the amplitude, and to the phase; empty if unknown.
    pub contributions: [Vec<Contribution>; 2],
}

/// The band of an output to show: the first that is resolved to the end, or else the first.
pub fn foremost<T>(bands: &[T], is_resolved: impl Fn(&T) -> bool) -> Option<&T> {
    bands.iter().find(|band| is_resolved(band)).or(bands.first())
}

/// A method's bounds of one output over time, and how far they may be from the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The method that bounds.
    pub method: Method,
    /// Lower bound at each time, in the output's SI unit; NaN if unknown.
    pub lower: Vec<f64>,
    /// Upper bound at each time, in the output's SI unit; NaN if unknown.
    pub upper: Vec<f64>,
    /// Error of the bounds, at each time.
    pub error: BandError,
}

impl OutputBounds {
    /// The same over `rows` rows; the additional rows are unknown.
    #[must_use]
    pub fn padded(&self, rows: usize) -> Self {
        let band = |band: &Band| Band {
            method: band.method,
            lower: padded(&band.lower, rows, f64::NAN),
            upper: padded(&band.upper, rows, f64::NAN),
            error: BandError {
                total: padded(&band.error.total, rows, f64::NAN),
                unresolved: padded(&band.error.unresolved, rows, true),
                coarse: padded(&band.error.coarse, rows, false),
                ..band.error.clone()
            },
        };
        Self {
            nominal: padded(&self.nominal, rows, f64::NAN),
            bands: self.bands.iter().map(band).collect(),
            ..self.clone()
        }
    }
}

impl Contribution {
    /// The same over `rows` rows; the additional rows are unknown.
    #[must_use]
    pub fn padded(&self, rows: usize) -> Self {
        Self {
            parameter: self.parameter.clone(),
            main: padded(&self.main, rows, f64::NAN),
            total: padded(&self.total, rows, f64::NAN),
            width_without: padded(&self.width_without, rows, f64::NAN),
        }
    }
}

fn padded<T: Clone>(values: &[T], rows: usize, with: T) -> Vec<T> {
    let mut values = values.to_vec();
    values.resize(rows, with);
    values
}
