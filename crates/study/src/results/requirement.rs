//! Requirements and their verdicts.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

/// Whether a requirement is fulfilled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// For the whole box, the stated error included.
    Holds,
    /// Neither is known.
    Undecided,
    /// A simulated sample does not fulfil it, by more than the error of its steps.
    Violated,
}

impl Verdict {
    /// In files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Violated => "violated",
            Self::Undecided => "undecided",
        }
    }
}

/// A requirement with its verdict. Numbers are in the requirement's SI unit, `null` if unknown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementSummary {
    /// Its name in the model.
    pub name: String,
    /// The requirement as the model writes it: `x3 >= 0.4 m`.
    pub text: String,
    /// SI unit of the margin; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see the margin, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Whether it is fulfilled.
    pub verdict: Verdict,
    /// Whether certified bounds prove the verdict.
    pub certified: bool,
    /// Distance of the bounds from the limit over the whole box: negative if they pass it. The truth is within `error`.
    pub margin: f64,
    /// The margin in percent of the limit; absent if the limit is zero or no constant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub percent: Option<f64>,
    /// Error of the margin.
    pub error: f64,
    /// The part of the error that is due to the method.
    pub surrogate: f64,
    /// The part of the error that is due to time steps.
    pub time: f64,
    /// Name of the method whose bounds decide.
    pub method: String,
    /// The simulated sample that is nearest to failing, or fails most; absent if none was simulated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<NearestCase>,
    /// Advice on how to decide it, if it is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decides: Option<String>,
    /// Limits that are constants, for marks in plots.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<LimitLine>,
}

/// The simulated sample that is nearest to failing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NearestCase {
    /// Values of the uncertain parameters in the summary's order, SI.
    pub parameters: Vec<f64>,
    /// Its margin: negative if it fails.
    pub margin: f64,
    /// Error of its margin due to the time steps.
    pub error: f64,
    /// When it is nearest, s; absent without a time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Whether every parameter is at an end of its interval.
    pub corner: bool,
    /// Settings that give a run these parameters, for `--set`: `l1=0.15 m`.
    pub settings: Vec<String>,
    /// The command that shows it; empty if the model is of no file.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub command: String,
}

/// A constant limit of an output over some time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LimitLine {
    /// Name of the output, or of the reduced output.
    pub output: String,
    /// The limit, in the output's SI unit.
    pub value: f64,
    /// Whether values above it fail; else those below it do.
    pub is_upper: bool,
    /// From when, s.
    pub from: f64,
    /// Until when, s.
    pub to: f64,
}

impl RequirementSummary {
    /// Adds another piece of the box: the worse one decides.
    pub fn add_piece(&mut self, other: &Self) {
        let certified = self.certified && other.certified;
        let is_worse = (other.verdict, -other.margin) > (self.verdict, -self.margin);
        if is_worse {
            *self = other.clone();
        }
        self.certified = certified;
    }
}
