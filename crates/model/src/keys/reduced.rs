//! Outputs that are one number a motion, and requirements.

use schemars::JsonSchema;

use super::*;
use crate::grammar::mapping::schema_only;

schema_only! {
    /// A formula, of every time; or one number a motion.
    #[schemars(untagged, inline)]
    pub enum OutputFile {
        Formula(Number),
        Shown(Box<OutputFormula>),
        Reduced(Box<Reduced>),
    }

    /// A comparison, or limits of an output.
    #[schemars(untagged, inline)]
    pub enum RequirementFile {
        Comparison(String),
        Limits(Box<Requirement>),
    }

    /// Abscissa and ordinate of a path, or an ordinate that is compared with a `line`.
    #[schemars(untagged, inline)]
    pub enum PathFile {
        Path([Number; 2]),
        Ordinate(Number),
    }
}

grammar! {
    /// A formula, of every time, and how it is shown.
    OutputFormula is "an output" {
        /// Formula of the output.
        formula: Number,
        /// Unit in which plots, reports and tables show it, e.g. `mm`. Numbers in files stay in SI.
        unit: Option<UnitName>,
    }

    /// One number a motion. Exactly one of the first keys says which.
    Reduced is "a reduced output" {
        /// The greatest value less the smallest of this formula.
        range: Option<Number>,
        /// The greatest value of this formula.
        max: Option<Number>,
        /// The smallest value of this formula.
        min: Option<Number>,
        /// The greatest magnitude of this formula.
        max_abs: Option<Number>,
        /// The value at the end, or at the time `to`.
        r#final: Option<Number>,
        /// The value at the time `at`.
        value: Option<Number>,
        /// The mean over the time.
        mean: Option<Number>,
        /// The root of the mean square.
        rms: Option<Number>,
        /// The integral over the time.
        integral: Option<Number>,
        /// When this formula is greatest, s.
        time_of_max: Option<Number>,
        /// When this formula is smallest, s.
        time_of_min: Option<Number>,
        /// When this comparison holds first, s: `door.angle > 1.2`.
        when: Option<String>,
        /// When this comparison holds last, s.
        last_when: Option<String>,
        /// Time from which on this formula stays within `band` of `target`, s.
        settling: Option<Number>,
        /// How far this formula goes beyond `target`, seen from its start; without `target`, beyond its value at the
        /// end.
        overshoot: Option<Number>,
        /// Width of the narrowest strip that holds this path; with `line`, the greatest distance from that.
        straightness: Option<PathFile>,
        /// Time from which on the motion counts, s.
        from: Option<Number>,
        /// Time until which the motion counts, s.
        to: Option<Number>,
        /// The time of `value`, s.
        at: Option<Number>,
        /// Value that `settling` and `overshoot` lead to.
        target: Option<Number>,
        /// Half the width of the band of `settling`.
        band: Option<Number>,
        /// Line that the ordinate of `straightness` is compared with.
        line: Option<Number>,
        /// Unit in which reports and tables show it, e.g. `mm`. Numbers in files stay in SI.
        unit: Option<UnitName>,
    }

    /// Limits of an output at all times, or of a reduced output.
    Requirement is "a requirement" {
        /// A comparison: `x3 >= 0.4 m`; instead of `output`.
        that: Option<String>,
        /// An output, a reduced output, a result of the analysis, or a formula of them.
        output: Option<Number>,
        /// The largest value allowed.
        max: Option<Number>,
        /// The smallest value allowed.
        min: Option<Number>,
        /// Time from which on it is required, s.
        from: Option<Number>,
        /// Time until which it is required, s.
        to: Option<Number>,
        /// The only time at which it is required, s.
        at: Option<Number>,
    }
}
