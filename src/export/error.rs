//! Reasons why results could not be written.

use std::io;
use std::path::PathBuf;

/// Why results could not be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum ExportError {
    #[error("cannot write into the folder {}: {source}", path.display())]
    Folder { path: PathBuf, source: io::Error },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot write the table of bounds: {0}")]
    Csv(#[from] csv::Error),
    #[error("cannot write the summary: {0}")]
    Json(#[from] serde_json::Error),
    #[error("cannot plot `{output}`: {message}")]
    Plot { output: String, message: String },
}
