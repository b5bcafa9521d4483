//! Samples over a step schedule: many at once, or one as a polynomial in the uncertain parameters.

mod extrapolated;
mod jet_states;
mod jets;
mod lane_steps;
mod observed;
pub(super) mod reduction;
mod row_accelerations;
mod row_closure;
mod run;
mod switch_extents;
mod tiling;
pub(crate) mod tuning;
mod watches;

pub(crate) use extrapolated::weights;
pub use extrapolated::{ExtrapolatedJets, ExtrapolatedRun};
pub use jet_states::JetBox;
pub(in crate::simulate) use jet_states::corrections;
pub use jets::JetRun;
pub(in crate::simulate) use observed::stops_of_lost;
pub use observed::{Observed, Stop};
pub(in crate::simulate) use reduction::Accumulator;
pub use reduction::{Accumulation, Channel};
pub(crate) use row_closure::Needs;
pub(in crate::simulate) use row_closure::{JetClosure, RowClosure};
pub use run::EnsembleRun;
pub(in crate::simulate) use tiling::{put_lanes, tiles};
