//! A language server of model files (`mbint lsp`): diagnostics, completion, hover, definitions, references, renaming,
//! outline, folding and formatting, over the language server protocol on standard input and
//! output, or over a connection within the process.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_language::{grammar, syntax};
use mbint_model::{elements, model};
use mbint_study::study;

mod lsp;

pub use lsp::{ServerError, attend, path_of, serve, tuning, uri_of};
