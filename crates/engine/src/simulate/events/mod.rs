//! Events: instants at which equations switch, and motions that are cut there.
//!
//! Where all samples meet the same events in the same order, each segment between two of them has steps that are the
//! same shares of its length in all samples, whose lengths are their own.
//!
//! - `locate`: where a function of the time changes its sign within a step;
//! - `segments`: the events that all samples have, and the steps between them;
//! - `path`: one sample by the explicit method, whose steps end at events, and `word`: whether all meet the same;
//! - `stretched`: segments on a time from 0 to 1, and `tile`: samples on it in lockstep;
//! - `run`: an ensemble, row by row.

pub(in crate::simulate) mod locate;
mod path;
mod run;
pub(in crate::simulate) mod segments;
mod stretched;
mod tile;
mod word;

pub use run::SegmentRun;
pub use word::segments_of;
