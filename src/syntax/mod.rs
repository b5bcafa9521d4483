//! Text → a tree in which every node knows its place, and the diagnostics that point there.

mod commas;
pub(crate) mod diagnostic;
pub(crate) mod frame;
mod habit;
mod harmless;
pub(crate) mod mesh_file;
pub(crate) mod mirrors;
mod not_yaml;
mod render;
pub(crate) mod scope;
pub(crate) mod source;
pub(crate) mod suggest;
pub(crate) mod text_file;
mod tree;
pub(crate) mod within;
pub(crate) mod yaml;

pub use diagnostic::{Diagnostics, Record};
pub use harmless::{harmless, is_harmful};
pub(crate) use text_file::regular;
