//! From a `Description` to motions: equations of motion (`assemble`), programs for residuals and Jacobians (`compile`),
//! and HHT-I3, explicit and certified integration of samples in lanes (`simulate`).

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_certificate::certificate;
use mbint_language::{grammar, multibody, syntax};
use mbint_model::{elements, model};
use mbint_numerics::numerics;

pub mod assemble;
pub mod c_code;
pub mod compile;
pub mod reduce;
pub mod simulate;
