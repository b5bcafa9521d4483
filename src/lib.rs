#![doc = include_str!("../docs/guides/rust.md")]
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

mod api;
mod cli;

pub use api::{Axis, Band, Error, Model, ModelBuilder, Output, Samples, Study, StudyResult, Sweep, Value, write_cost};
/// Proofs of certified bounds, as in [`results::Bounds::certified`], and their checker, which shares no code with their
/// construction.
pub use mbint_certificate::certificate;
/// Results as data: contents of `summary.json`, allocations, statistics and studies of costs.
pub use mbint_study::results;
#[doc(inline)]
pub use methods::Method;
#[doc(inline)]
pub use model::{Formulation, SchemeChoice};
#[doc(inline)]
pub use numerics::RangeKind;
#[doc(inline)]
pub use results::{
    Convergence, DerivativeCheck, EffectBalance, Exchange, FormulationVerification, GradientParameter, Gradients,
    OutputGradients, PowerBalance, Quantity, ReducedGradients, SchemeVerification, Summary, Verification,
};
#[doc(inline)]
pub use syntax::Diagnostics;

// Rooms of the crates below are reachable under their names here.
use mbint_applications::applications;
use mbint_engine::{c_code, simulate};
use mbint_equations::{assemble, compile, reduce};
use mbint_export::{export, overview};
use mbint_language::{grammar, syntax};
use mbint_methods::methods;
use mbint_model::{elements, model};
use mbint_numerics::numerics;
use mbint_study::{store, study};

#[doc(hidden)]
pub mod inner;
