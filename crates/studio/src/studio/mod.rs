//! A session on a page: `serve` is the entrance. `guard` says who is answered, `routes` how; `desk` is shared by the page
//! and three workers: `bounds` reads and bounds the model, `samples` simulates outputs, and `moves` the mechanism.

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

pub use serve::{Options, StudioError, serve};
