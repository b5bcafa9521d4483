//! Bounds → files: CSV, summary and plots.

mod columns;
mod contributions;
mod cost;
mod courses;
mod csv;
mod drawing;
mod error;
mod figure;
mod files;
mod folder;
mod overlay;
mod owned;
mod plot;
mod reference;
mod scenes;
mod snapshot;

pub use self::csv::bounds_csv;
pub use columns::columns_json;
pub use contributions::{contributions_csv, contributions_svg};
pub use cost::write_cost;
pub use drawing::write_drawing;
pub use error::ExportError;
pub use files::{file_stem, write_results};
pub use folder::{prepare_folder, write_pages};
pub use overlay::SceneBounds;
pub use owned::holds_complete_results;
pub use plot::{noise, plot_svg};
pub use reference::effects as effects_page;
pub use scenes::write_scenes;
pub use snapshot::{Moved, Snapshot, moved, snapshot_file, snapshot_table, write_snapshot};
