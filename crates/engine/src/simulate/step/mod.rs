//! One step of a scheme for a tile of samples.

mod local_error;
mod newton;
mod pace;
mod pivots;
mod prediction;
mod rank_revealing;
mod rounding;
mod stepper;
pub(crate) mod tuning;

pub use local_error::LocalError;
pub use newton::Counters;
pub(in crate::simulate) use pace::Pace;
pub use stepper::{StepFailure, Stepper};
