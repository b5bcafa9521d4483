//! From results to files and texts: CSV, SVG, JSON summaries, snapshots, the report that moves in a browser, and the
//! overview of a run.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below are reachable under their names here.
use mbint_certificate::certificate;
use mbint_engine::simulate;
use mbint_equations::compile;
use mbint_language::{grammar, syntax};
use mbint_methods::methods;
use mbint_model::{elements, model};
use mbint_numerics::numerics;
use mbint_study::{results, store};

pub mod export;
pub mod overview;
