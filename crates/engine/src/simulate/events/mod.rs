//! Events: instants at which equations switch.
//!
//! - `locate`: where a function of the time changes its sign within a step.

pub(in crate::simulate) mod locate;
