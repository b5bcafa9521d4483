//! Bounding methods. Each asks an `Ensemble` for samples or jets and returns bands with stated errors; none knows
//! how a sample is simulated.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_certificate::certificate;
use mbint_language::{grammar, multibody, syntax};
use mbint_numerics::numerics;

pub mod methods;
