//! Program → trajectories.
//!
//! - `start`: a consistent start, the rank of the constraints there;
//! - `simulator`: a mechanism assembled and compiled, and `error`: why it cannot be;
//! - `step`: one step of a scheme for a tile of samples: stepper, Newton's iteration, the rank-revealing solve;
//! - `control`: the step schedule that all samples share, fixed or from a tolerance;
//! - `ensemble`: many samples, or one jet in the parameters, over a schedule;
//! - `diagnostics`: singular configurations, constraints that cannot be closed, undetermined reactions;
//! - `closure`: the motion from independent coordinates, without integration;
//! - `enclosure`: certified motions over a box of parameters.

mod closure;
mod control;
mod diagnostics;
mod enclosure;
mod ensemble;
mod error;
mod simulator;
mod start;
mod step;

pub use closure::{Closure, Points, choose_independent};
pub use control::{Controller, Schedule, ToleranceSchedule, schedule_for_tolerance};
pub use diagnostics::{OpenConstraint, SingularPass};
pub use enclosure::{Certifier, Enclosure, EnclosureError};
pub use ensemble::{EnsembleRun, JetRun, Observed, Stop};
pub use error::SimulationError;
pub use simulator::{Assembled, Simulator};
pub use step::{Counters, Stepper};
