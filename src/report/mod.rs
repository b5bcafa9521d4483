//! Bounds → files: CSV, summary and plots.

mod axis;
mod cost;
mod cost_plot;
mod csv;
mod explanation;
mod files;
mod front;
mod log_axis;
mod plot;
mod polyline;
mod summary;
mod view;

pub use self::csv::bounds_csv;
pub use cost::{CostMethod, CostPoint, CostReference, CostStudy, Deviation, cost_csv, cost_curves, write_cost};
pub use cost_plot::cost_svg;
pub use explanation::{EffectExplanation, Explanation, InstructionCounts, LeftOut, NewtonMatrix};
pub use files::{ReportError, file_stem, prepare_folder, write_results};
pub use front::pareto;
pub use plot::plot_svg;
pub use summary::{MethodSummary, ParameterSummary, Summary};
