//! The steps of a subsystem's samples.
//!
//! `validated` has the model's own steps and the samples that measure their error, `controlled` those from a tolerance
//! of the steps, `explicit` those of the explicit method, `balance` those from a tolerance of the bounds (`search`), and
//! `events` those between events; `switches` searches the box for events that no sample meets.

mod balance;
mod controlled;
mod events;
mod explicit;
mod search;
mod switches;
mod validated;

pub use balance::balance;
pub use controlled::{controlling_samples, schedule_within};
pub use events::{events_of_parts, segmented};
pub use explicit::{OF_STEPS, decision, explicit_samples, explicit_steps, explicit_within, may_be_explicit, refused};
pub use search::StepSearch;
pub use switches::switches;
pub use validated::{damped_modes, divided, integration, may_extrapolate, validation};
