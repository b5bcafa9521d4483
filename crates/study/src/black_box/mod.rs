//! Programs that answer instead of a mechanism: points in, rows out.
//!
//! A [`Pool`] has processes of one program (`process`), cuts points into calls, and asks again where one fails. How
//! points and rows are written is a protocol: JSON lines (`json`) or tables (`csv`). The room knows numbers and names,
//! and no study. Guide: `docs/guides/black-box.md`.

mod answers;
mod csv;
mod json;
mod pool;
mod process;
mod trouble;

pub use pool::{Pool, Unanswered};
pub use trouble::Trouble;

/// Questions that every point has in common.
#[derive(Clone, Debug)]
pub struct Questions {
    /// Names of the numbers that the program is given.
    pub parameters: Vec<String>,
    /// Names of its outputs, each with the size of its unit in SI.
    pub outputs: Vec<(String, f64)>,
    /// Times of the rows, s.
    pub times: Vec<f64>,
}

/// A point's rows, in SI: row by row, output by output.
pub type Answer = Result<Vec<f64>, Trouble>;
