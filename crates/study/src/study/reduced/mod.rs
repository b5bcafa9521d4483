//! Reduced outputs and requirements: bounds of one number a motion, and verdicts.
//!
//! `expand` makes outputs of their arguments; `plan` lists the accumulated quantities, `values` computes values from
//! them; `ensemble` presents them to the methods, and `bound` runs these; `verdicts` decides requirements, some of them
//! `by_rows` (`found` has all of it); `answers` puts those of subsystems together; `keeping`, `kept` and `margins`
//! evaluate them after the run; `refine` runs a model until all are decided. `simulated` has those of samples.

mod answers;
mod bound;
mod by_rows;
mod ensemble;
mod evaluated;
mod expand;
mod found;
mod keeping;
mod kept;
mod margins;
mod occurring;
mod part;
mod plan;
mod refine;
mod simulated;
mod slopes;
pub(crate) mod tuning;
mod values;
mod verdicts;

pub(super) use answers::{Parameters, together};
pub(super) use bound::{plan_reduction, reduced};
pub(super) use ensemble::{Store, steps_of};
pub use expand::expanded;
pub(super) use expand::shown;
pub(super) use found::Found;
pub use kept::KeptReduced;
pub use margins::{Margins, MarginsOfPart, ReducedValues};
pub use refine::run;
pub(super) use simulated::values_of_samples;
