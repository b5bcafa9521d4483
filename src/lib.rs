#![doc = include_str!("../docs/guides/rust.md")]
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

mod api;

pub use api::{Band, Error, Model, ModelBuilder, Output, Study, StudyResult, Value};
pub use methods::Method;
pub use results::Summary;
pub use syntax::Diagnostics;

// The rooms of the house, in the order of the data flow.
mod assemble;
mod cli;
mod compile;
mod elements;
mod export;
mod grammar;
mod methods;
mod model;
mod multibody;
mod numerics;
mod reduce;
mod results;
mod simulate;
mod store;
mod study;
mod syntax;

#[doc(hidden)]
pub mod inner;
