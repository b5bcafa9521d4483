//! Laws of parameters, statistics and costs of tolerances.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::grammar::mapping::schema_only;

schema_only! {
    #[schemars(rename_all = "snake_case", inline)]
    pub enum LawName {
        /// Every value as likely as any other; the default.
        Uniform,
        /// Normal law, also beyond the interval; unless stated otherwise, the tolerance is three standard deviations.
        Normal,
        /// The same, cut off at the interval's ends.
        TruncatedNormal,
        /// Likeliest at the value, linearly less towards the ends.
        Triangular,
    }

    /// A law by its name, or with its numbers.
    #[schemars(untagged, inline)]
    pub enum LawFile {
        Name(LawName),
        Full(Box<LawKinds>),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum FixedName {
        Fixed,
    }

    /// Cost of a tolerance.
    #[schemars(untagged, inline)]
    pub enum CostFile {
        /// The tolerance stays as it is.
        Fixed(FixedName),
        Full(Box<CostKinds>),
    }
}

grammar! {
    /// A law with its numbers.
    LawKinds is "a `distribution`" {
        /// Every value as likely as any other.
        uniform: Option<NoNumbers>,
        /// Normal law, also beyond the interval.
        normal: Option<NormalLaw>,
        /// Normal law, cut off at the interval's ends.
        truncated_normal: Option<NormalLaw>,
        /// Law whose logarithm is normal, also beyond the interval.
        lognormal: Option<LognormalLaw>,
        /// Linear density to and from the mode.
        triangular: Option<TriangularLaw>,
        /// A beta law over the interval.
        beta: Option<BetaLaw>,
        /// Pairs of a value, in the parameter's unit, and a density, linear between them; it need not be normalised.
        table: Option<Vec<(Number, f64)>>,
    }

    /// A law without numbers.
    NoNumbers is "`uniform`" {}

    /// Mean and standard deviation.
    NormalLaw is "a normal law" {
        /// Standard deviation; by default a third of the tolerance.
        sigma: Option<Number>,
        /// Mean; by default the middle of the interval.
        mean: Option<Number>,
    }

    /// Median, and standard deviation of the logarithm.
    LognormalLaw is "`lognormal`" {
        /// Standard deviation of the natural logarithm: of 0.1, the value is off by about 10 %.
        sigma: f64,
        /// Median; by default the parameter's value.
        median: Option<Number>,
    }

    /// A triangle.
    TriangularLaw is "`triangular`" {
        /// The likeliest value; by default the parameter's.
        mode: Option<Number>,
    }

    /// Exponents of the beta law, plus one.
    BetaLaw is "`beta`" {
        /// Exponent at the lower end, plus one.
        alpha: f64,
        /// Exponent at the upper end, plus one.
        beta: f64,
    }

    /// Questions about the outputs' distribution, besides the bounds.
    Statistics is "`statistics`" {
        /// The law of every uncertain parameter that has none of its own; by default uniform.
        distribution: Option<LawFile>,
        /// Samples of the surrogate, by default a million; a power of two is taken. Under random excitations motions
        /// are simulated, by default 4096.
        samples: Option<u32>,
        /// Whole number that chooses the samples of random excitations; by default 1.
        seed: Option<u32>,
        /// Under random excitations: time, s, within which failures of requirements are counted; motions are parts of
        /// it.
        exposure: Option<Number>,
        /// Shares below the quantiles, e.g. `[0.135%, 50%, 99.865%]`, which is the default.
        quantiles: Option<Vec<Number>>,
        /// Parameters that depend on each other, group by group.
        correlation: Option<Vec<CorrelationFile>>,
    }

    /// Correlated parameters.
    CorrelationFile is "a correlation" {
        /// Names of uncertain parameters.
        of: Vec<String>,
        /// Correlation coefficient of any two of them.
        coefficient: Option<f64>,
        /// Instead: a row for each, with ones on the diagonal.
        matrix: Option<Vec<Vec<f64>>>,
    }

    /// How cost depends on the tolerance.
    CostKinds is "a `cost`" {
        /// The cost at the model's tolerance; it is inversely proportional to the tolerance.
        reciprocal: Option<f64>,
        /// Costs by grade: `IT5` to `IT12` of ISO 286-1, or a tolerance such as `0.02 mm`.
        grades: Option<IndexMap<String, f64>>,
        /// The nominal size by which ISO 286 chooses the width of a grade; by default the parameter's value.
        size: Option<Number>,
    }
}
