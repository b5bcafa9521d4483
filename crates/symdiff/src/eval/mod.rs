//! Evaluation of tapes: over samples ([`tile`]), and backwards ([`Adjoints`]); with twice the digits
//! ([`double_double`]); over polynomials ([`jet`]) and their enclosures ([`taylor_model`]); and of expressions over
//! intervals (`ranges`).

mod adjoints;
pub mod double_double;
mod enclosed;
pub(crate) mod functions;
pub mod interval;
pub mod jet;
pub mod math;
mod ranges;
pub mod sincos;
pub mod taylor_model;
pub mod tile;
mod vectorised;

pub use adjoints::Adjoints;
pub use ranges::Ranges;
pub use vectorised::{LaneWork, Vectorise, in_lanes, instruction_set, lanes, lanes_mut, vectorised};
