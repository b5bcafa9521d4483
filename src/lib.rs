//! mbint: what a mechanism can do when its parameters are only known up to tolerances.
//!
//! The data flow, one module a stage: [`syntax`] → `grammar` → [`elements`] → [`model`] → [`reduce`] → [`assemble`] → [`compile`] →
//! [`simulate`] → [`results`] → [`export`]; [`study`] orchestrates, [`methods`] bound what is simulated, by [`numerics`].

pub mod assemble;
#[doc(hidden)]
pub mod cli;
pub mod compile;
pub mod elements;
pub mod export;
pub(crate) mod grammar;
pub mod methods;
pub mod model;
pub mod multibody;
pub mod numerics;
pub mod reduce;
pub mod results;
pub mod simulate;
pub mod study;
pub mod syntax;
