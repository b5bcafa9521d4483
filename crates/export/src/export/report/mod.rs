//! `report.html`: a run's results to be looked at. The page is made of the other files of the results alone, so that it
//! can be made again from them; `motion.json` has the rest.

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
pub use folder::write_report;
pub use motion::ReportParts;
pub(super) use motion::{MOTION, motion_json};
pub(super) use page::{PageFigure, PageScene, page};
pub(super) use plain::{Section, plain_page};
