//! Text → a tree of nodes with their locations, and the diagnostics that point there.

pub mod codes;
mod commas;
pub mod diagnostic;
pub mod frame;
mod habit;
mod harmless;
pub mod mesh_file;
pub mod mirrors;
mod not_yaml;
mod render;
pub mod scope;
pub mod source;
pub mod suggest;
pub mod table;
pub mod text_file;
mod tree;
pub mod tuning;
pub mod within;
pub mod yaml;

pub use codes::{Code, Coded};
pub use diagnostic::{Diagnostics, Record};
pub use harmless::{harmless, is_harmful};
pub use render::wrapped;
pub use text_file::regular;
