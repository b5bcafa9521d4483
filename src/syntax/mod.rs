//! Text → a tree in which every node knows its place, and the diagnostics that point there.

mod commas;
pub(crate) mod diagnostic;
mod habit;
mod harmless;
mod not_yaml;
mod render;
pub(crate) mod scope;
pub(crate) mod source;
pub(crate) mod suggest;
pub(crate) mod text_file;
mod tree;
pub(crate) mod yaml;

pub use diagnostic::{Diagnostics, Record};
pub use harmless::{harmless, is_harmful};
