//! Samples, or a jet, under the scheme, whose steps end at rows of output.
//!
//! - `tile`: samples in lanes; `lane_steps`: those that need shorter steps, `watches`: diagnostics of each step;
//! - `jets`: one sample as a polynomial in the uncertain parameters, and `jet_stepper`: its steps;
//! - `row_closure`: rows from states that are no step's own.

mod jet_states;
mod jet_stepper;
mod jets;
mod lane_steps;
mod row_accelerations;
mod row_closure;
mod switch_extents;
mod tile;
pub(crate) mod tuning;
mod watches;

pub use jet_states::JetBox;
pub(in crate::simulate) use jet_states::corrections;
pub(in crate::simulate) use jet_stepper::JetStepper;
pub use jets::JetRun;
pub(crate) use row_closure::Needs;
pub(in crate::simulate) use row_closure::{JetClosure, RowClosure};
pub use tile::EnsembleRun;
