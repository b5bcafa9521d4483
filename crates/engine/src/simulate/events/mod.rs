//! Events: instants at which equations switch, and motions that are cut there.
//!
//! Samples that meet the same events in the same order have one word. Each segment between two of these events has
//! steps that are the same shares of its length in all samples of the word, whose lengths are their own.
//!
//! - `locate`: where a function of the time changes its sign within a step;
//! - `segments`: the words of a box, the steps between their events, and the boundaries between words;
//! - `path`: one sample, whose steps end at events, `path_step`: a step, and `followed`: its word;
//! - `scheme_steps`: steps of HHT-I3 for motions that are stiff, and `level_stepper`: those of one level;
//! - `word`: the words of some samples, `resolved`: their steps, and `boundary`: the surfaces between them;
//! - `same_instants`: steps that end at events whose times are the same in all samples;
//! - `stretched`: segments on a time from 0 to 1, `nodes`: states there, and `tile`: samples on it in lockstep;
//! - `run`: an ensemble, `rows`: its rows, and `jets`: a jet;
//! - `saltation`: adjoints through events.

mod boundary;
mod followed;
mod jets;
mod level_stepper;
pub(in crate::simulate) mod locate;
mod nodes;
mod path;
mod path_step;
mod resolved;
mod rows;
mod run;
mod saltation;
mod same_instants;
mod scheme_steps;
pub(in crate::simulate) mod segments;
mod stretched;
mod tile;
pub(crate) mod tuning;
mod word;

pub use jets::{outputs_of_jets, segment_jets};
pub use run::SegmentRun;
pub(in crate::simulate) use saltation::{EventAdjoints, EventSteps};
pub use segments::{Boundary, Following, SegmentMethod, WordsEnd};
pub use word::cut_at_events;
