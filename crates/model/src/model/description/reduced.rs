//! Outputs that are one number a motion, and requirements on outputs.

use symdiff::Formula;

use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;

/// An output that is one number a motion.
#[derive(Clone, Debug)]
pub struct ReducedOutput {
    /// Its name.
    pub name: String,
    /// Its definition in the file: `max of pin.force`.
    pub text: String,
    /// SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// Dimension; `None` if unknown.
    pub dimension: Option<Dimension>,
    /// Reduction of the motion.
    pub kind: ReducedKind,
    /// The reduced formula, over names of [`Description::symbol`](super::Description::symbol).
    pub sources: Vec<Formula>,
    /// Indices of these among the outputs, once they are there.
    pub outputs: Vec<usize>,
    /// Time from which on the motion counts, s.
    pub from: f64,
    /// Until when, s.
    pub to: f64,
    /// Whether the formulas name results of the analysis, and outputs, instead of the motion.
    pub of_results: bool,
}

/// Reduction of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReducedKind {
    /// The greatest value less the smallest.
    Range,
    /// The greatest value.
    Max,
    /// The smallest value.
    Min,
    /// The greatest magnitude.
    MaxAbs,
    /// The value at the end of the time.
    Value,
    /// The mean over the time.
    Mean,
    /// The root of the mean square.
    Rms,
    /// The integral over the time.
    Integral,
    /// When it is greatest.
    TimeOfMax,
    /// When it is smallest.
    TimeOfMin,
    /// When the source is first not negative.
    When,
    /// When the source is last not negative.
    LastWhen,
    /// Time from which on the source stays negative.
    Settling,
    /// How far it goes beyond its target (the second source; without one, its own value at the end), seen from its
    /// start.
    Overshoot,
    /// The width of the narrowest strip that holds the path of both sources.
    Straightness,
}

/// A requirement: every slack must not be negative.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// Its name.
    pub name: String,
    /// Its text in the file.
    pub text: String,
    /// SI unit of the slacks; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see the slacks, if the limited quantity has one.
    pub display: Option<DisplayUnit>,
    /// Distance of the limits from the limited quantity.
    pub slacks: Vec<Formula>,
    /// Indices of these among the outputs, once they are there.
    pub outputs: Vec<usize>,
    /// Interval of time in which they count; `None` if they are of reduced outputs and parameters, by their names.
    pub times: Option<(f64, f64)>,
    /// Constant limits.
    pub limits: Vec<Limit>,
    /// Whether the slacks name results of the analysis, and outputs, instead of the motion.
    pub of_results: bool,
}

/// A constant limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The limited quantity, as the file writes it.
    pub of: String,
    /// The limit, SI.
    pub value: f64,
    /// Whether values above it fail; else those below it do.
    pub is_upper: bool,
}
