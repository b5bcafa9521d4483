//! From a file to a `Description`: formats of robots (`robots`), elements (joints, effects, shapes), the keys of a
//! model file with its schema (`keys`), the model's tree written out (`expand`), and its meaning (`model`).

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_language::{grammar, multibody, syntax};
use mbint_methods::methods;
use mbint_numerics::numerics;

pub mod elements;
mod expand;
mod keys;
pub mod model;
mod robots;
