//! From a file to a `Description`: the elements (joints, effects, shapes) and the readers of YAML, URDF and MJCF.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_language::{grammar, multibody, syntax};
use mbint_methods::methods;
use mbint_numerics::numerics;

pub mod elements;
pub mod model;
