//! From a `Description` to programs: the parts to simulate (`reduce`), equations of motion as expressions (`assemble`),
//! and residuals and Jacobians as instructions (`compile`). Nothing here integrates.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_certificate::certificate;
use mbint_language::{grammar, multibody};
use mbint_model::{elements, model};
use mbint_numerics::numerics;

pub mod assemble;
pub mod compile;
pub mod reduce;
