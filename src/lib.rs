//! mbint: what a mechanism can do when its parameters are only known up to tolerances.
//!
<<<<<<< HEAD
//! The data flow, one module a stage: [`syntax`] → [`model`] → [`reduce`] → [`assemble`] → [`compile`] → [`simulate`] → [`results`] →
//! [`export`]; [`study`] orchestrates, [`methods`] bound what is simulated, by [`numerics`].
=======
//! The data flow, one module a stage: [`syntax`] → `grammar` → [`model`] → [`reduce`] → [`assemble`] → [`compile`] → [`simulate`] → [`numerics`] → [`results`] → [`export`]; [`study`] orchestrates.
>>>>>>> study

pub mod assemble;
pub mod cli;
pub mod compile;
pub mod export;
<<<<<<< HEAD
pub mod methods;
=======
pub(crate) mod grammar;
>>>>>>> study
pub mod model;
pub mod numerics;
pub mod reduce;
pub mod results;
pub mod simulate;
pub mod study;
pub mod syntax;
