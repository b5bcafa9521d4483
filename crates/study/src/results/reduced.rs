//! Reduced outputs: one number a motion, bounded over the box.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

/// A reduced output's bounds. Numbers are in the output's SI unit, `null` if unknown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReducedSummary {
    /// Its name in the model.
    pub name: String,
    /// Its definition in the model: `max of pin.force`.
    pub of: String,
    /// Its SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// With every parameter at its nominal value.
    pub nominal: f64,
    /// Bounds by every method, in the order of [`Method`](super::Method).
    pub bands: Vec<ReducedBand>,
    /// Contributions of the parameters, the largest total index first; empty if unknown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contributions: Vec<ReducedContribution>,
    /// The simulated sample with the smallest value, and the one with the largest; absent if no sample has a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<[WorstCase; 2]>,
    /// Set if some of the samples have no value, for example because an event does not occur: number of simulated
    /// samples that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub occurs: Option<Occurrence>,
}

/// A method's bounds of a reduced output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReducedBand {
    /// Name of the method.
    pub method: String,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Error of the bounds.
    pub error: f64,
    /// The part of the error that is due to the method.
    pub surrogate: f64,
    /// The part of the error that is due to time steps.
    pub time: f64,
    /// Whether the bounds are not resolved: their error is too large relative to their width.
    pub unresolved: bool,
}

/// A parameter's part in the spread of a reduced output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReducedContribution {
    /// Name of the parameter.
    pub parameter: String,
    /// First-order Sobol index: variance due to this parameter alone.
    pub main: f64,
    /// Total Sobol index: variance due to this parameter and its interactions.
    pub total: f64,
    /// Width of the range if this parameter were at its nominal value.
    pub width_without: f64,
}

/// A simulated sample: its parameters in the summary's order, SI, and its value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstCase {
    /// Values of the uncertain parameters.
    pub parameters: Vec<f64>,
    /// The value there.
    pub value: f64,
}

/// Number of samples that have a value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Occurrence {
    /// Number of samples with a value.
    pub samples: usize,
    /// Number of samples.
    pub of: usize,
    /// Parameters of one that has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub absent: Option<Vec<f64>>,
    /// Share of the box in which there is a value, at least and at most, if the box was divided for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share: Option<[f64; 2]>,
}

impl ReducedSummary {
    /// Adds another piece of the box. Of several pieces together, contributions and shares are not known.
    pub fn add_piece(&mut self, other: &Self) {
        for (band, more) in self.bands.iter_mut().zip(&other.bands) {
            // NaN is passed on.
            let worse = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
            band.lower = -worse(-band.lower, -more.lower);
            band.upper = worse(band.upper, more.upper);
            band.error = worse(band.error, more.error);
            band.surrogate = worse(band.surrogate, more.surrogate);
            band.time = worse(band.time, more.time);
            band.unresolved |= more.unresolved;
        }
        self.contributions.clear();
        self.worst = match (self.worst.take(), other.worst.clone()) {
            (Some([a, b]), Some([c, d])) => {
                Some([if c.value < a.value { c } else { a }, if d.value > b.value { d } else { b }])
            }
            (own, more) => own.or(more),
        };
        match (&mut self.occurs, &other.occurs) {
            (Some(own), Some(more)) => {
                own.samples += more.samples;
                own.of += more.of;
                own.share = None;
            }
            (own, more) => *own = own.take().or_else(|| more.clone()),
        }
    }
}
