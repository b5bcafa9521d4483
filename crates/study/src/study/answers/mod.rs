//! From what methods found under one schedule to bounds, a summary and kept surrogates.
//!
//! `results` holds the findings, `conclude` makes bounds and the summary of it, with `analysis` and `assemblies`;
//! `keeping` and `kept` keep surrogates for those who evaluate them after the run.

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
