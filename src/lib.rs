#![doc = include_str!("../docs/guides/rust.md")]

mod api;

pub use api::{Band, Error, Model, ModelBuilder, Output, Study, StudyResult, Value};
pub use methods::Method;
pub use results::Summary;
pub use syntax::Diagnostics;

// The rooms of the house, in the order of the data flow. They are public for this package's own binary, tests and benches;
// what is in them may change with any version.
#[doc(hidden)]
pub mod assemble;
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod compile;
#[doc(hidden)]
pub mod elements;
#[doc(hidden)]
pub mod export;
pub(crate) mod grammar;
#[doc(hidden)]
pub mod methods;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod multibody;
#[doc(hidden)]
pub mod numerics;
#[doc(hidden)]
pub mod reduce;
#[doc(hidden)]
pub mod results;
#[doc(hidden)]
pub mod simulate;
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod syntax;
