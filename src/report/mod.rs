//! Bounds → files: CSV, summary and plots.

mod axis;
mod contributions;
mod cost;
mod csv;
mod effect_cost;
mod explanation;
mod files;
mod folder;
mod plot;
mod polyline;
mod summary;
mod view;

pub use self::csv::bounds_csv;
pub use contributions::{contributions_csv, contributions_svg};
pub use cost::{
    CostMethod, CostPoint, CostReference, CostStudy, Deviation, cost_csv, cost_curves, cost_svg, pareto, write_cost,
};
pub use effect_cost::{EffectCost, StepInstructions};
pub use explanation::{EffectExplanation, Explanation, InstructionCounts, LeftOut, NewtonMatrix};
pub use files::{ReportError, file_stem, write_results};
pub use folder::prepare_folder;
pub use plot::plot_svg;
pub use summary::{
    ContributionSummary, ErrorSummary, MethodSummary, ParameterSummary, PieceSummary, SingularSummary, Summary,
};
