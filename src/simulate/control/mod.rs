//! The step schedule that all samples share: fixed, or controlled by a tolerance.

mod controller;
mod samples;
mod schedule;

pub use samples::{ToleranceSchedule, schedule_for_tolerance};
pub use schedule::Schedule;
