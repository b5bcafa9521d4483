//! The step schedule that all samples share: fixed, or controlled by a tolerance.

mod adaptive;
mod controller;
mod samples;
mod schedule;
mod switch_watch;

pub use adaptive::Adaptive;
pub use controller::Controller;
pub use samples::{ToleranceSchedule, schedule_for_tolerance};
pub use schedule::Schedule;
pub use switch_watch::SwitchWatch;
