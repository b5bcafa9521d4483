//! One driver of all runs: from row to row, for tiles of samples and for jets, by whatever scheme.
//!
//! - `integrator`: an ensemble of samples, or one jet, that is integrated in one way;
//! - `row_tile`: lanes that advance together, which each scheme has its own of;
//! - `tiled_run`: tiles on all cores, row by row;
//! - `extrapolated`: the same on several levels of steps, combined;
//! - `motion`: rates of a state, and rows that are closed from it, in lanes or in coefficients, and `motion_steps`:
//!   steps of it;
//! - `observed`: values that a row records, and samples that stop;
//! - `reduction`: outputs accumulated from step to step to one number;
//! - `tiling`: how samples are divided among tiles.

mod extrapolated;
mod integrator;
mod motion;
mod motion_steps;
mod observed;
pub(super) mod reduction;
mod row_tile;
mod tiled_run;
mod tiling;
pub(super) mod tuning;

pub(crate) use extrapolated::weights;
pub(in crate::simulate) use extrapolated::{ClosedRows, Extrapolated};
pub use integrator::Integrator;
pub(in crate::simulate) use motion::{Motion, RowState};
pub(in crate::simulate) use motion_steps::MotionSteps;
pub use observed::{Observed, Stop};
pub(in crate::simulate) use observed::{forget_lost, lost_lanes};
pub(in crate::simulate) use reduction::Accumulator;
pub use reduction::{Accumulation, Channel};
pub(in crate::simulate) use row_tile::RowTile;
pub use tiled_run::TiledRun;
pub(in crate::simulate) use tiling::tiles;
pub(in crate::simulate) use tuning::TUNING;
