//! Program → trajectories: a consistent start, and a scheme's steps over tiles of samples.

mod closure;
mod enclosure;
mod fleet;
mod hht;
mod initial;
mod jets;
mod lock;
mod newton;
mod pilot;
mod rank;
mod reactions;
mod simulator;
mod singular;
mod steps;

pub use closure::{Closure, Points, choose_independent};
pub use enclosure::{Certifier, Enclosure, Lost};
pub use fleet::{Fleet, Observed, Stop};
pub use hht::{LocalError, Stepper, Stuck};
pub use jets::JetRun;
pub use newton::Counters;
pub use pilot::{Piloted, schedule as schedule_for_tolerance};
pub use simulator::{Mobility, SimulationError, Simulator};
pub use singular::SingularPass;
pub use steps::{Controller, Schedule};
