//! `report.html`: a run's results to be viewed. The page is made of the other files of the results alone, so that it
//! can be made again from them; `motion.json` has the rest.

mod derivatives;
mod folder;
mod html;
mod motion;
mod packing;
mod page;
mod plain;
mod script;
mod statistics;
mod tables;
mod visuals;

pub(super) use folder::page_of_folders;
pub use folder::{results_article, write_report};
pub(super) use motion::MOTION;
pub use motion::{ReportParts, motion_json};
pub(super) use page::{PageFigure, PageScene, page};
pub(super) use plain::{Section, plain_page};
pub use script::{REPORT_STYLE, report_module};
