//! A study asks a model's questions of its simulations: bounds, reduced outputs, requirements, statistics and
//! gradients. `results` holds the answers, `store` keeps simulations on disk, `black_box` asks programs.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_certificate::certificate;
use mbint_engine::{c_code, simulate};
use mbint_equations::{assemble, compile, reduce};
use mbint_language::{grammar, syntax};
use mbint_methods::methods;
use mbint_model::{elements, model};
use mbint_numerics::numerics;

mod black_box;
pub mod results;
pub mod store;
pub mod study;
