//! Evaluation of tapes: over samples ([`tile`]), polynomials ([`jet`]) and their enclosures ([`taylor_model`]).

pub(crate) mod functions;
pub mod interval;
pub mod jet;
pub mod math;
pub mod sincos;
pub mod taylor_model;
pub mod tile;
mod vectorised;

pub use vectorised::{Vectorise, vectorised};
