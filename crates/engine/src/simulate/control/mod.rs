//! The step schedule that all samples share: fixed, or controlled by a tolerance; in both cases divided where functions
//! of the time ask for it.

mod adaptive;
mod chatter;
mod controller;
mod division;
mod instants;
mod integration;
mod refinement;
mod samples;
mod schedule;
mod switch_watch;
pub(crate) mod tuning;

pub use adaptive::Adaptive;
pub use controller::{Controller, Steps};
pub use division::Divided;
pub use integration::Integration;
pub use samples::{ToleranceSchedule, schedule_for_tolerance};
pub use schedule::Schedule;
pub use switch_watch::SwitchWatch;
