//! The studio (`mbint studio`): a page for one person on one machine. It edits the text of a model with the language
//! server's help, moves its mechanism, and shows its bounds as they are computed.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below are reachable under their names here.
use mbint_engine::simulate;
use mbint_export::export;
use mbint_language::syntax;
use mbint_methods::methods;
use mbint_model::model;
use mbint_numerics::numerics;
use mbint_study::{results, study};

mod studio;

pub use studio::{Options, StudioError, serve, tuning};
