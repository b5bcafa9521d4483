//! What a file may say: reading, checking, and the typed [`Description`].

mod description;
mod names;

pub use description::*;
