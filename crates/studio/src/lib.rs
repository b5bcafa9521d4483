//! The studio (`mbint studio`): a page for one person on one machine, on which the text of a model is edited with the
//! language server's help, its mechanism is moved, and its bounds come in as they are computed.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_engine::simulate;
use mbint_export::export;
use mbint_language::syntax;
use mbint_methods::methods;
use mbint_model::model;
use mbint_numerics::numerics;
use mbint_study::{results, study};

mod studio;

pub use studio::{Options, StudioError, serve, tuning};
