//! Programs that answer instead of a mechanism: points in, rows out.
//!
//! A [`Pool`] has processes of one program (`process`), cuts points into calls, and asks again if one fails. How
//! points and rows are written is a protocol: JSON lines (`json`) or tables (`csv`). The room knows numbers and names,
//! and no study. Guide: `docs/guides/black-box.md`.

mod answers;
mod csv;
mod json;
mod launch;
mod pool;
mod process;
mod questions;
mod trouble;
pub(crate) mod tuning;

pub use pool::{Pool, Unanswered};
pub use questions::Questions;
pub use trouble::Trouble;

/// A point's rows, in SI: row by row, output by output.
pub type Answer = Result<Vec<f64>, Trouble>;
