//! The playground: models read and run in a page, by a module of WebAssembly without files, network and threads.
//!
//! A question and its answer are JSON ([`answer`]); `abi` has the functions that a page's worker calls.

#![deny(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below are reachable under their names here.
use mbint_engine::simulate;
use mbint_export::{export, overview};
use mbint_language::syntax;
use mbint_model::model;
use mbint_study::{results, study};

#[cfg(target_family = "wasm")]
#[allow(unsafe_code, reason = "linear memory is shared with the page")]
mod abi;
mod playground;

pub use playground::{Host, answer};
