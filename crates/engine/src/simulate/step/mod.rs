//! One step of a scheme for a tile of samples.

mod newton;
mod pivots;
mod prediction;
mod rank_revealing;
mod rounding;
mod stepper;
pub(crate) mod tuning;

pub use newton::Counters;
pub(in crate::simulate) use stepper::Pace;
pub use stepper::{LocalError, StepFailure, Stepper};
