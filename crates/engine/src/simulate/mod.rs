//! Program → trajectories.
//!
//! - `start`: a consistent start, the rank of the constraints there;
//! - `simulator`: a mechanism assembled and compiled, and `error`: why it cannot be;
//! - `step`: one step of a scheme for a tile of samples: stepper, Newton's iteration, the rank-revealing solve;
//! - `time_functions`: functions of the time in the equations, and the steps that resolve them;
//! - `control`: the step schedule that all samples share, fixed or from a tolerance;
//! - `ensemble`: many samples, or one jet in the parameters, over a schedule;
//! - `explicit`: the same by an explicit method of order 8, and `sample_run`: whichever a schedule asks for;
//! - `sampling`: states that change at instants, at which steps end;
//! - `diagnostics`: singular configurations, constraints that cannot be closed, undetermined reactions;
//! - `closure`: the motion from independent coordinates, without integration;
//! - `unmet_switch`: contacts and kinks that some parameter values meet and no sample does;
//! - `features`: bumps, waves and tables in space that a step may pass over;
//! - `modes`: fast modes that the start excites and the steps damp;
//! - `enclosure`: certified motions over a box of parameters.

mod closure;
mod control;
mod derived;
mod diagnostics;
mod enclosure;
mod ensemble;
mod error;
mod excitations;
mod explicit;
mod fast_states;
mod features;
mod further;
mod modal;
mod modes;
mod motion_values;
mod residual_text;
mod sample_run;
mod sampling;
mod simulator;
mod start;
mod statics;
mod step;
mod time_functions;
mod unmet_switch;
mod visit;

pub use closure::{Closure, Points, choose_independent};
pub use control::{Controller, Divided, Integration, Schedule, Steps, ToleranceSchedule, schedule_for_tolerance};
pub use diagnostics::{OpenConstraint, SingularPass, SingularWatch, TooDeep};
pub use enclosure::{Certifier, Enclosure, EnclosureError};
pub use ensemble::{Accumulation, Channel, EnsembleRun, ExtrapolatedJets, JetRun, Observed, Stop};
pub use error::SimulationError;
pub use explicit::{ExplicitJets, ExplicitObstacle, explicit_schedule};
pub use modal::is_one_number;
pub use modes::{ExcitedMode, excited_modes};
pub use sample_run::SampleRun;
pub use simulator::{Assembled, Simulator};
pub use step::{Counters, Stepper};
pub use time_functions::TimeFunctions;
pub use unmet_switch::{SwitchSearch, unmet_switch};
pub use visit::Visit;
