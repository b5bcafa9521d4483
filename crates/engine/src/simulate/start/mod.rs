//! A consistent start: positions, velocities, accelerations and multipliers that fulfil the constraints.

mod assembly;
mod general_position;
mod mobility;
mod open;
mod orientation;
mod rank;
mod settling;
pub(crate) mod tuning;

pub(crate) use assembly::allowed_residual;
pub(super) use assembly::{Assembly, ConstraintResidual};
pub(super) use general_position::{guess_state, move_apart, pivot_samples, spread};
pub use mobility::Mobility;
pub(super) use mobility::{contradiction, jacobian_rows, mobility, usual_row_sizes};
pub use open::Samples;
pub(super) use open::{open_start, shared_coordinates};
pub(super) use orientation::{Orientation, Oriented};
pub(super) use rank::{dependent_rows, free_columns, row_independence};
