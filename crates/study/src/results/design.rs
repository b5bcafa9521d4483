//! Nominal values before and after they are chosen.

use serde::Serialize;

use super::{AllocatedTolerance, Allocation, Criterion, NotMet, RequirementSummary};
use crate::grammar::display_unit::DisplayUnit;

/// A parameter whose nominal value was free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignParameter {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Ends of its range, SI.
    pub range: [f64; 2],
    /// Ends of the part of it that was searched: less if the mechanism cannot be assembled everywhere.
    pub searched: [f64; 2],
}

/// Objective of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignObjective {
    /// `least toe`, `most stroke`, `margin`, or `cost`.
    pub text: String,
    /// SI unit of its value; empty if dimensionless, unknown, or a share of limits.
    pub unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Whether small values are good.
    pub is_least: bool,
}

/// The kind of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DesignKind {
    /// The model's own nominal values.
    Model,
    /// The best ones if there were no tolerances.
    Nominal,
    /// The best ones with tolerances, at least near by.
    Optimum,
}

/// A choice of nominal values, with a study of its own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignPoint {
    /// Origin.
    pub kind: DesignKind,
    /// By parameter, SI.
    pub values: Vec<f64>,
    /// Deviations upwards and downwards about each, SI.
    pub deviations: Vec<[f64; 2]>,
    /// The objective without deviations, in its SI unit.
    pub nominal: f64,
    /// The objective in the worst case, or its quantile for a share of the production.
    pub worst: f64,
    /// Error of `worst`.
    pub error: f64,
    /// Verdicts of the study.
    pub requirements: Vec<RequirementSummary>,
    /// The share that fulfils all requirements, at least; absent for worst cases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Whether all requirements hold by that study.
    pub is_feasible: bool,
    /// Parameters whose range ends there.
    pub at_limits: Vec<String>,
}

/// The objective along one parameter, through the best point: on a surrogate of the ranges, if there is one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignProfile {
    /// Index of the parameter.
    pub parameter: usize,
    /// Its values, SI, ascending.
    pub values: Vec<f64>,
    /// The objective without deviations.
    pub nominal: Vec<f64>,
    /// The objective in the worst case, or its quantile.
    pub worst: Vec<f64>,
}

/// The cheapest nominal values and tolerances that leave a margin, with a study of their own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignTrade {
    /// The least margin of all requirements, as a share of its limit: in the worst case, or its quantile.
    pub margin: f64,
    /// Error of `margin`.
    pub error: f64,
    /// Cost of the tolerances.
    pub cost: f64,
    /// Nominal values of the free parameters, SI.
    pub values: Vec<f64>,
    /// All tolerances, before and after.
    pub tolerances: Vec<AllocatedTolerance>,
    /// Verdicts of the study.
    pub requirements: Vec<RequirementSummary>,
    /// The share that fulfils all requirements, at least; absent for worst cases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
}

/// Result of a search for nominal values.
#[derive(Clone, Debug, Serialize)]
pub struct DesignStudy {
    /// Name of the model.
    pub model: String,
    /// Objective.
    pub objective: DesignObjective,
    /// Criterion of requirements and objective.
    pub criterion: Criterion,
    /// Free parameters.
    pub parameters: Vec<DesignParameter>,
    /// Optima, the best first; if no point is feasible, the nearest ones.
    pub optima: Vec<DesignPoint>,
    /// The model's own point; absent if it cannot be run.
    pub model_point: Option<DesignPoint>,
    /// The best point without tolerances, with its worst case; absent without tolerances, or if it cannot be run.
    pub nominal_point: Option<DesignPoint>,
    /// Requirements that the best point does not meet.
    pub not_met: Vec<NotMet>,
    /// The cheapest tolerances at the best point, and cost against margin there; absent if tolerances have no cost.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allocation: Option<Allocation>,
    /// Cost against margin, with nominal values and tolerances of each point, from the cheapest on; empty where
    /// tolerances have no cost, or an output is the objective.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front: Vec<DesignTrade>,
    /// The objective about the best point, by parameter.
    pub profiles: Vec<DesignProfile>,
    /// Simulations for surrogates.
    pub simulations: usize,
    /// Simulations of the studies at points.
    pub confirming: usize,
}

impl DesignStudy {
    /// The best point.
    pub fn best(&self) -> Option<&DesignPoint> {
        self.optima.first()
    }

    /// Whether the cost of tolerances is the objective.
    pub fn is_priced(&self) -> bool {
        self.objective.text == "cost"
    }

    /// Gain of the worst case over that of the nominal optimum, as a share of the latter.
    pub fn gain(&self) -> Option<f64> {
        let (best, nominal) = (self.best()?, self.nominal_point.as_ref()?);
        // Tolerances that miss the requirements have a cost, too.
        if self.is_priced() && !(best.is_feasible && nominal.is_feasible) {
            return None;
        }
        let gain = if self.objective.is_least { nominal.worst - best.worst } else { best.worst - nominal.worst };
        // A value within its error is no base of a share.
        (nominal.worst.abs() > nominal.error + best.error).then(|| gain / nominal.worst.abs())
    }
}
