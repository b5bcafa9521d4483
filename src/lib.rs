//! mbint: what a mechanism can do when its parameters are only known up to tolerances.
//!
//! The way of the data, one module a stage: [`model`] → [`reduce`] → [`mechanics`] → program → integrate → [`bounds`] → [`report`].

pub mod batch;
pub mod bounds;
pub mod cli;
pub mod integrate;
pub mod mechanics;
pub mod model;
pub mod program;
pub mod reduce;
pub mod report;
