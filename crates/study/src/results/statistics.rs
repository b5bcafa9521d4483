//! Distributions of outputs, in addition to their bounds.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

/// An estimate with its error: `sampling` is the half width of the 95 % confidence interval, `error` the possible
/// contribution of the surrogate and the time steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Uncertain {
    /// The estimate.
    pub value: f64,
    /// Half width of its 95 % confidence interval due to the number of samples.
    pub sampling: f64,
    /// Possible error due to the surrogate and the time steps.
    pub error: f64,
}

impl Uncertain {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self { value: f64::NAN, sampling: f64::NAN, error: f64::NAN };

    /// Both together.
    pub fn total(&self) -> f64 {
        self.sampling + self.error
    }
}

/// An output's distribution over time; each vector runs over the times.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputStatistics {
    /// Name in the model.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Mean.
    pub mean: Vec<Uncertain>,
    /// Standard deviation.
    pub deviation: Vec<Uncertain>,
    /// By quantile.
    pub quantiles: Vec<Vec<Uncertain>>,
    /// Linearised worst case about the nominal value, to either side: Σ |∂y/∂pᵢ| Δpᵢ.
    pub linear: Vec<f64>,
    /// Root sum square of the same, to either side: √Σ (∂y/∂pᵢ Δpᵢ)².
    pub rss: Vec<f64>,
    /// Whether the numbers of a row can be relied on.
    pub resolved: Vec<bool>,
}

/// The law of a parameter, as it is printed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawSummary {
    /// Name of the parameter.
    pub parameter: String,
    /// `uniform`, `normal`, ….
    pub distribution: String,
    /// Mean, SI.
    pub mean: f64,
    /// Standard deviation, SI.
    pub deviation: f64,
    /// Whether the tolerance is taken for three standard deviations, since nothing else is said.
    pub tolerance_is_three_sigma: bool,
    /// Probability outside the interval that is bounded.
    pub outside: f64,
}

/// Statistics of a run; serialised as their summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatisticsResult {
    /// Output times, s.
    #[serde(skip)]
    pub times: Vec<f64>,
    /// In the model's order.
    #[serde(skip)]
    pub outputs: Vec<OutputStatistics>,
    /// For people and `summary.json`.
    #[serde(flatten)]
    pub summary: StatisticsSummary,
}

/// Statistics in `summary.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StatisticsSummary {
    /// Samples of the surrogate in each row.
    pub samples: usize,
    /// Laws of the parameters.
    pub parameters: Vec<LawSummary>,
    /// Shares below the quantiles.
    pub quantiles: Vec<f64>,
    /// Probability outside the domain of the surrogate; samples are drawn from the rest.
    pub left_out: f64,
    /// Largest probability outside the box that is bounded.
    pub outside: f64,
    /// Simulations for a surrogate beyond the box, if laws reach beyond it.
    pub simulations: usize,
    /// Number of simulated products, if the errors are determined by them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub products: Option<usize>,
    /// By output, at the time at which it varies most.
    pub outputs: Vec<OutputStatisticsSummary>,
    /// Reduced outputs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reduced: Vec<NumberStatistics>,
    /// Share that fulfils each requirement.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<YieldSummary>,
    /// The same for all requirements together, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub together: Option<YieldSummary>,
    /// Under random excitations: motions are the samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub random: Option<RandomSummary>,
    /// Reason why it, or a part of it, is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// Random excitations of samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RandomSummary {
    /// Their names.
    pub excitations: Vec<String>,
    /// Seed of the samples.
    pub seed: usize,
}

/// An output's distribution at the time at which its standard deviation is largest: worst case, RSS and statistics side
/// by side. SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputStatisticsSummary {
    /// Name.
    pub output: String,
    /// SI unit.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// When, s.
    pub time: f64,
    /// Bounds over the box: every case.
    pub worst_case: [f64; 2],
    /// The error of these bounds.
    pub worst_case_error: f64,
    /// With every parameter at its nominal value.
    pub nominal: f64,
    /// Linearised worst case about it, to either side.
    pub linear: f64,
    /// Root sum square, to either side.
    pub rss: f64,
    /// Mean.
    pub mean: Uncertain,
    /// Standard deviation.
    pub deviation: Uncertain,
    /// In the order of the shares.
    pub quantiles: Vec<Uncertain>,
    /// Sensitivities of a stack of dimensions to each uncertain parameter, the largest deviation first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensitivities: Vec<Sensitivity>,
    /// Histogram of the samples of a stack of dimensions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub histogram: Option<Histogram>,
}

/// Sensitivity of an output to a parameter about the nominal values. SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Name of the parameter.
    pub parameter: String,
    /// ∂y/∂p, with its sign.
    pub derivative: f64,
    /// ∂y/∂p Δp, with its sign: Δp is the larger deviation of the parameter from its nominal value.
    pub deviation: f64,
    /// Share of the sum of all squared deviations.
    pub share: f64,
}

/// Shares of samples in intervals of equal width.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Lower end of the first interval, SI.
    pub lower: f64,
    /// Upper end of the last interval, SI.
    pub upper: f64,
    /// Interval by interval; their sum is 1.
    pub shares: Vec<f64>,
}

/// Distribution of a reduced output. SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NumberStatistics {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Mean.
    pub mean: Uncertain,
    /// Standard deviation.
    pub deviation: Uncertain,
    /// In the order of the shares.
    pub quantiles: Vec<Uncertain>,
}

/// The share of the production that fulfils a requirement, by samples of the surrogate of its margin: over the whole
/// motion, between rows too.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct YieldSummary {
    /// Name of the requirement.
    pub requirement: String,
    /// The share that fulfils it.
    pub share: f64,
    /// Its 95 % confidence interval, widened by the errors of surrogate and steps and by the probability outside the
    /// domain of the surrogate.
    pub interval: [f64; 2],
    /// Parts per million that do not fulfil it, and the same interval.
    pub ppm: f64,
    /// The same interval of `ppm`.
    pub ppm_interval: [f64; 2],
    /// Under random excitations: failures within a longer time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure: Option<ExposureSummary>,
    /// Capability at the worst time, (U − L)/(6σ); of a requirement with two limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cp: Option<f64>,
    /// Capability at the worst time, the mean's distance from the nearer limit over 3σ; that of the margin for a
    /// reduced output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpk: Option<f64>,
    /// When that is, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Samples.
    pub samples: usize,
    /// Method that found the share, if failures are too rare for plain samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub method: Option<String>,
}

/// First passage of a limit within a time that is longer than the motion, of which parts fail independently of one
/// another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExposureSummary {
    /// The time, s.
    pub time: f64,
    /// Parts per million that fail within it.
    pub ppm: f64,
    /// Their 95 % confidence interval.
    pub ppm_interval: [f64; 2],
}
