//! Parameters that agree with measured values.

use serde::Serialize;

use super::tuning::TUNING;
use crate::grammar::display_unit::DisplayUnit;
use crate::numerics::Paving;

/// A measured value, and the model's at the least-squares estimate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitRow {
    /// Line of the file, from 1.
    pub line: usize,
    /// s
    pub time: f64,
    /// Index of the output among [`Fit::outputs`].
    pub output: usize,
    /// Measured value, SI.
    pub measured: f64,
    /// Bound of its noise, SI.
    pub noise: f64,
    /// Simulated at the estimate, SI; NaN if the motion stops before.
    pub fitted: f64,
    /// Error of simulation, surrogate and interpolation in time in the last round, SI; infinite if the row carries no
    /// information.
    pub error: f64,
}

/// A measured output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitOutput {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
}

/// A parameter before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitParameter {
    /// Name in the model.
    pub name: String,
    /// SI unit, empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip)]
    pub display: Option<DisplayUnit>,
    /// The model's interval, SI.
    pub prior: [f64; 2],
    /// Least squares, SI.
    pub estimate: f64,
    /// Standard deviation of the estimate, SI; infinite if the data do not determine it.
    pub deviation: f64,
    /// Hull of the consistent set, SI: values outside of it contradict the data.
    pub hull: Option<[f64; 2]>,
    /// Hull of the inner paving, SI.
    pub inner: Option<[f64; 2]>,
    /// Middle of the consistent set: its centroid, SI.
    pub middle: Option<f64>,
}

/// A principal axis of the consistent set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitAxis {
    /// A unit vector in multiples of the parameters' half intervals.
    pub direction: Vec<f64>,
    /// Extent of the set along it, in the same units: 2 if a single parameter is left as open as the model has it.
    pub extent: f64,
}

/// Shadow of the consistent set on two parameters, as rectangles of a raster.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitProjection {
    /// Indices of the parameters.
    pub parameters: [usize; 2],
    /// Rectangles that cover the shadow of the outer paving: lower and upper end of the first, then of the second
    /// parameter, SI.
    pub outer: Vec<[f64; 4]>,
    /// Rectangles whose middles lie in that of the inner paving.
    pub inner: Vec<[f64; 4]>,
}

/// The set of all parameters with which every measured value is within its noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConsistentSet {
    /// Volumes of the inner and of the outer paving, as shares of the model's box.
    pub volumes: [f64; 2],
    /// Boxes of both.
    pub boxes: [usize; 2],
    /// Principal axes, the longest first: the combination that the data leave most open.
    pub axes: Vec<FitAxis>,
    /// Projections on each pair of parameters.
    pub projections: Vec<FitProjection>,
    /// Names of parameters whose interval ends before the set does.
    pub at_limits: Vec<String>,
    /// The pavings.
    #[serde(skip)]
    pub paving: SkewPaving,
}

/// Boxes along skew axes: ξ = center + axes · η, in multiples of the half intervals from the middle of the model's box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkewPaving {
    /// ξ of the middle (k).
    pub center: Vec<f64>,
    /// Inverse of the matrix of the axes (k × k), row by row.
    pub inverse: Vec<f64>,
    /// Boxes of η.
    pub boxes: Paving,
}

impl SkewPaving {
    /// Whether ξ lies in the outer paving.
    pub fn may_contain(&self, xi: &[f64]) -> bool {
        let away: Vec<f64> = xi.iter().zip(&self.center).map(|(xi, center)| xi - center).collect();
        let along = |row: &[f64]| row.iter().zip(&away).map(|(entry, away)| entry * away).sum();
        let eta: Vec<f64> = self.inverse.chunks_exact(away.len()).map(along).collect();
        self.boxes.may_contain(&eta)
    }
}

/// No parameters agree with all rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unexplained {
    /// With noise larger by this factor there are some, about the least-squares estimate.
    pub factor: f64,
    /// Rows that no parameters of the model's box explain, each on its own, with the necessary excess over the noise,
    /// in the output's SI unit; the largest excess relative to its noise first.
    pub alone: Vec<(usize, f64)>,
    /// The row without which the others agree best, and the factor by which the noise of the others would have to be
    /// larger: up to 1 if they agree.
    pub worst: Option<(usize, f64)>,
}

/// Parameters and measured values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Name of the model.
    pub model: String,
    /// Measured outputs.
    pub outputs: Vec<FitOutput>,
    /// Uncertain parameters.
    pub parameters: Vec<FitParameter>,
    /// Measured values.
    pub rows: Vec<FitRow>,
    /// Root mean square of the residuals at the estimate, in multiples of the noise bounds.
    pub residual: f64,
    /// Correlations of the estimate, row by row.
    pub correlations: Vec<Vec<f64>>,
    /// All parameters with which every row is within its noise; absent if there are none, or more than
    /// [`Fit::MOST_PARAMETERS`].
    pub set: Option<ConsistentSet>,
    /// Why there are none.
    pub unexplained: Option<Unexplained>,
    /// Simulations for surrogates.
    pub simulations: usize,
}

impl Fit {
    /// Most parameters for which the set is paved.
    pub const MOST_PARAMETERS: usize = TUNING.most_parameters;
}
