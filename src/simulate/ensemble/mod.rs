//! Samples over a step schedule: many at once, or one as a polynomial in the uncertain parameters.

mod extrapolated;
mod jets;
mod lane_steps;
mod reduction;
mod row_accelerations;
mod row_closure;
mod run;
mod sample_run;
mod switch_extents;

pub use extrapolated::ExtrapolatedJets;
pub use jets::JetRun;
pub use reduction::{Accumulation, Channel};
pub use run::{EnsembleRun, Observed, Stop};
pub use sample_run::SampleRun;
