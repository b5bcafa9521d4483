//! Samples over a step schedule: many at once, or one as a polynomial in the uncertain parameters.

mod jets;
mod lane_steps;
mod reduction;
mod row_accelerations;
mod run;
mod switch_extents;

pub use jets::JetRun;
pub use reduction::{Accumulation, Channel};
pub use run::{EnsembleRun, Observed, Stop};
