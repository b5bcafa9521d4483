//! Bounds → files: CSV, summary and plots.

mod axis;
mod canvas;
mod contributions;
mod cost;
mod csv;
mod decisions;
mod effect_cost;
mod explanation;
mod figure;
mod files;
mod folder;
mod overlay;
mod panel;
mod plot;
mod polyline;
mod scenes;
mod summary;
mod view;

pub use self::csv::bounds_csv;
pub use contributions::{contributions_csv, contributions_svg};
pub use cost::{
    CostMethod, CostPoint, CostReference, CostStudy, Deviation, cost_csv, cost_curves, cost_svg, pareto, write_cost,
};
pub use decisions::{Decision, Each, Saving};
pub use effect_cost::{EffectCost, StepInstructions};
pub use explanation::{EffectExplanation, Explanation, InstructionCounts, LeftOut, NewtonMatrix};
pub use files::{ReportError, file_stem, write_results};
pub use folder::prepare_folder;
pub use overlay::overlay_svg;
pub use plot::plot_svg;
pub use scenes::{SceneBounds, scenes_csv, write_scenes};
pub use summary::{
    ContributionSummary, ErrorSummary, IslandSummary, MethodSummary, ParameterSummary, PieceSummary, SingularSummary,
    Summary,
};
