//! A session on a page; `serve` is the entrance. `guard` admits requests, `routes` answers them. Workers share `desk`
//! with the page: `bounds` reads and bounds the model, `samples` simulates outputs, `moves` the mechanism, and `watch`
//! follows files that other programs change.

mod answer;
mod board;
mod bounds;
mod connection;
mod desk;
mod guard;
mod language;
mod moves;
mod page;
mod questions;
mod report;
mod requests;
mod routes;
mod samples;
mod serve;
mod texts;
pub mod tuning;
mod watch;

pub use serve::{Options, StudioError, serve};
