//! The steps of a subsystem's samples: a `plan` that all of them share, the `first` of which is tried before its errors
//! are known.
//!
//! `validated` has the model's own steps and the samples that measure their error, `controlled` those from a tolerance
//! of the steps, `explicit` those of the explicit method, `balance` those from a tolerance of the bounds, by a
//! `search`, and `events` those between events; `switches` searches the box for events that no sample meets.

mod balance;
mod controlled;
mod events;
mod explicit;
mod first;
mod plan;
mod search;
mod switches;
pub mod tuning;
mod validated;

pub use balance::{Balanced, balance};
pub use controlled::controlling_samples;
pub use events::{events_followed, events_of_parts, is_random, segmented, segmented_nominal, segmented_samples};
pub use explicit::{
    explicit_samples, explicit_steps, has_tighter_steps, integration_decision, may_be_explicit, refused,
};
pub use first::planned;
pub use plan::StepPlan;
pub use search::StepSearch;
pub use switches::switches;
pub use validated::{damped_modes, divided, integration, may_extrapolate, validation};
