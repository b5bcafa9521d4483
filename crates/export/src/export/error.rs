//! Reasons why results could not be written.

use std::io;
use std::path::PathBuf;

use super::owned::SUMMARY;
use crate::store::without;
use crate::syntax::{Code, Coded};

/// Reasons why results could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The folder cannot be made or locked.
    #[error("cannot write into the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Reason that the system gives.
        source: io::Error,
    },
    /// Another run writes into the folder, and the caller did not wait for it.
    #[error("another run writes into the folder {}", path.display())]
    Held {
        /// The folder.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason that the system gives.
        source: io::Error,
    },
    /// A folder has no results.
    #[error("{}, so there are no results to show; name the folder that `mbint run` wrote", without(folder, SUMMARY))]
    NoResults {
        /// The folder.
        folder: PathBuf,
    },
    /// A file of results cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Reason that the system gives.
        source: io::Error,
    },
    /// The table cannot be written as CSV.
    #[error("cannot write the table of bounds: {0}")]
    Csv(#[from] csv::Error),
    /// A value cannot be written as JSON.
    #[error("cannot write the results as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl Coded for ExportError {
    fn code(&self) -> Option<Code> {
        Some(match self {
            Self::NoResults { .. } | Self::Read { .. } => Code::NoResults,
            Self::Folder { .. } | Self::Held { .. } | Self::Write { .. } | Self::Csv(_) | Self::Json(_) => {
                Code::CannotWrite
            }
        })
    }
}
