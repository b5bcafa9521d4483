//! Why a store cannot be used.

use crate::syntax::{Code, Coded};
use std::path::{Path, PathBuf};

/// Why a store cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file or folder cannot be read or written.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        error: std::io::Error,
    },
    /// A folder has no plan.
    #[error(
        "{}, so there is no study in it; `mbint plan` makes a study's folder, which is to be named here",
        without(folder, file)
    )]
    NoStudy {
        /// The folder.
        folder: PathBuf,
        /// The file that is missing.
        file: &'static str,
    },
    /// A file does not have the content that its name states.
    #[error("{} is damaged, or of another version of mbint; remove it and plan again", path.display())]
    Damaged {
        /// Which.
        path: PathBuf,
    },
    /// Something cannot be written in the files' format.
    #[error("a value cannot be written: {0}")]
    Encoding(#[from] postcard::Error),
}

/// Why a file is not in a folder: neither may be there.
pub fn without(folder: &Path, file: &str) -> String {
    let shown = folder.display();
    match folder {
        _ if folder.is_dir() => format!("the folder {shown} has no {file}"),
        _ if folder.exists() => format!("{shown} is a file, not a folder"),
        _ => format!("there is no folder {shown}"),
    }
}

impl StoreError {
    /// An error of a file or folder.
    pub(super) fn io(path: &Path, error: std::io::Error) -> Self {
        Self::Io { path: path.to_owned(), error }
    }

    /// An error of a file whose content does not match its name.
    pub fn damaged(path: &Path) -> Self {
        Self::Damaged { path: path.to_owned() }
    }
}

impl Coded for StoreError {
    fn code(&self) -> Option<Code> {
        Some(match self {
            Self::Io { .. } | Self::Encoding(_) => Code::CannotWrite,
            Self::NoStudy { .. } | Self::Damaged { .. } => Code::NoStudy,
        })
    }
}
