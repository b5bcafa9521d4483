//! From programs to motions: HHT-I3, explicit and certified integration of samples in lanes (`simulate`), and the same
//! step as C99 (`c_code`).

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_certificate::certificate;
use mbint_equations::{assemble, compile};
use mbint_language::{grammar, syntax};
use mbint_model::model;
use mbint_numerics::numerics;

pub mod c_code;
pub mod simulate;
