//! Bounds → files: CSV, summary and plots.

mod summary;

pub use summary::{MethodSummary, ParameterSummary, Summary};
