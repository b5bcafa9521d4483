//! Tolerances before and after they are allocated.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;

use super::{RequirementSummary, YieldSummary};

/// Criterion by which a requirement limits tolerances.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// For every case of the box.
    WorstCase,
    /// For this share of the production, all requirements together.
    Share(f64),
}

/// A tolerance to either side, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ToleranceZone {
    /// Upwards.
    pub above: f64,
    /// Downwards.
    pub below: f64,
}

/// Tolerance of a parameter before and after an allocation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AllocatedTolerance {
    /// The parameter's name, as a model file has it.
    pub parameter: String,
    /// Its SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// Its nominal value; unknown of a deviation around another parameter.
    pub nominal: f64,
    /// As the model has it.
    pub before: ToleranceZone,
    /// As it was found.
    pub after: ToleranceZone,
    /// Grade of the process, if it has grades.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grade: Option<String>,
    /// Cost before; absent if unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost_before: Option<f64>,
    /// Cost after; absent if unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost_after: Option<f64>,
    /// Its share of the consumed margin of the tightest requirement before: of the linearised worst case, or of the
    /// variance.
    pub share_before: f64,
    /// The same, after.
    pub share_after: f64,
    /// Whether it was free to change.
    pub is_free: bool,
    /// Whether it reached the loosest multiple that was searched.
    pub at_widest: bool,
}

/// A requirement that no tolerances meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotMet {
    /// Name of the requirement.
    pub requirement: String,
    /// Its SI unit.
    pub unit: String,
    /// The unit in which people see the margin, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Its margin with the tightest tolerances: negative.
    pub margin: f64,
    /// Error of the margin.
    pub error: f64,
}

/// A point of cost against margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TradePoint {
    /// The share of the nominal margin that is left at least.
    pub margin: f64,
    /// Cost: the sum of all costs, or how much tighter all tolerances are.
    pub cost: f64,
}

/// Result of an allocation.
#[derive(Clone, Debug, Serialize)]
pub struct Allocation {
    /// Name of the model.
    pub model: String,
    /// Criterion of the requirements.
    pub criterion: Criterion,
    /// By parameter.
    pub tolerances: Vec<AllocatedTolerance>,
    /// The requirement that shares are of.
    pub tightest: String,
    /// Requirements that cannot be met; then tolerances are as before.
    pub not_met: Vec<NotMet>,
    /// Whether the cheapest grades are proven to be: not if there are too many of them.
    pub is_exhaustive: bool,
    /// Verdicts of a study of its own at the result.
    pub requirements: Vec<RequirementSummary>,
    /// Yields of that study.
    pub yields: Vec<YieldSummary>,
    /// Whether that study confirms the result.
    pub is_confirmed: bool,
    /// Cost against margin.
    pub trade: Vec<TradePoint>,
    /// The model's own tolerances there; absent if they do not meet the requirements or their cost is unknown.
    pub trade_before: Option<TradePoint>,
    /// The result there.
    pub trade_after: Option<TradePoint>,
    /// Simulations for the surrogate.
    pub simulations: usize,
    /// Simulations of the studies that confirm.
    pub confirming: usize,
    /// Largest error of the surrogate's margins, as a share of a nominal margin; `None` with many parameters, where it
    /// gives no information about the boxes that are chosen.
    pub surrogate_error: Option<f64>,
    /// Largest multiple of the model's tolerances that the surrogate reaches.
    pub widest: f64,
}

impl Allocation {
    /// Cost before and after, if all are known.
    pub fn costs(&self) -> [Option<f64>; 2] {
        let sum = |of: fn(&AllocatedTolerance) -> Option<f64>| -> Option<f64> {
            let priced = self.tolerances.iter().filter(|tolerance| tolerance.cost_after.is_some());
            priced.clone().next()?;
            priced.map(of).sum()
        };
        [sum(|tolerance| tolerance.cost_before), sum(|tolerance| tolerance.cost_after)]
    }
}
