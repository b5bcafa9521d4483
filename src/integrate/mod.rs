//! Program → trajectories: a consistent start, and HHT-I3 steps over tiles of samples.

mod assemble;
mod hht;
mod newton;
mod rank;
mod simulator;
mod steps;

pub use hht::{Stepper, Stuck};
pub use newton::Counters;
pub use simulator::{Mobility, SimulationError, Simulator};
pub use steps::{Controller, Schedule};
