//! Bounds, a summary and stored surrogates from the results of the methods under one schedule.
//!
//! `results` holds the findings, `conclude` makes bounds and the summary of it, with `analysis` and `assemblies`;
//! `keeping` and `kept` store surrogates for evaluation after the run.

mod analysis;
mod assemblies;
mod conclude;
mod functions;
mod keeping;
mod kept;
mod results;
pub(crate) mod tuning;

pub use analysis::arrange;
pub use assemblies::of as assemblies;
pub use conclude::{Note, conclude};
pub use keeping::keep_surrogate;
pub use kept::{Evaluator, Kept};
pub use results::{Ran, Results};
