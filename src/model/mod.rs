//! What a file may say: reading, checking, and the typed [`Description`].

mod description;
mod dimension;
pub mod diagnostic;
pub mod quantity;
mod names;
mod render;
pub mod source;
mod file;
mod suggest;
mod yaml;

pub use description::*;
pub use diagnostic::{Diagnostic, Diagnostics, Severity};
