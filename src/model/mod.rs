//! What a file may say: reading, checking, and the typed [`Description`].

mod description;
pub mod diagnostic;
mod render;
pub mod source;
mod suggest;
mod yaml;

pub use description::*;
pub use diagnostic::{Diagnostic, Diagnostics, Severity};
