//! The server and its answers; `serve` and `attend` are the entry points.

mod completion;
mod context;
mod format;
mod hover;
mod mechanism;
mod members;
mod names;
mod navigation;
mod outline;
mod problems;
mod proposal;
mod requests;
mod schema;
mod server;
mod text;
pub mod tuning;
mod uri;
mod values;
mod workspace;

pub use server::{ServerError, attend, serve};
pub use uri::{path_of, uri_of};
