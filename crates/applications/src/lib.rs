//! Applications of studies: a task asks one or many of them, and answers a person.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_engine::simulate;
use mbint_equations::{assemble, compile, reduce};
use mbint_language::{grammar, syntax};
use mbint_methods::methods;
use mbint_model::model;
use mbint_numerics::numerics;
use mbint_study::{results, study};

pub mod applications;
