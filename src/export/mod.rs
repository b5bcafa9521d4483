//! Bounds → files: CSV, summary and plots.

mod axis;
mod canvas;
mod contributions;
mod cost;
mod csv;
mod figure;
mod files;
mod folder;
mod overlay;
mod panel;
mod plot;
mod polyline;
mod reference;
mod scenes;
mod view;

pub use self::csv::bounds_csv;
pub use contributions::{contributions_csv, contributions_svg};
pub use cost::{cost_csv, cost_svg, write_cost};
pub use files::{ExportError, file_stem, write_results};
pub use folder::prepare_folder;
pub use overlay::overlay_svg;
pub use plot::plot_svg;
pub use reference::effects as effects_page;
pub use scenes::{SceneBounds, scenes_csv, write_scenes};
