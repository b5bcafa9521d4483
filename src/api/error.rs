//! What can go wrong between a file and its bounds.

use std::fmt;

use crate::export::ExportError;
use crate::model::UnknownScene;
use crate::study::{GradientError, RunError};
use crate::syntax::Diagnostics;

/// Why there is no model, or nothing of it could be run.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The model has errors: all of them, each with its place.
    #[error("{0}")]
    Model(#[source] Diagnostics),
    /// The model does not have the scene.
    #[error(transparent)]
    Scene(#[from] UnknownScene),
    /// The mechanism cannot be built, assembled or stepped.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Outputs have no derivatives by the parameters.
    #[error(transparent)]
    Gradient(#[from] Box<GradientError>),
    /// The files could not be written.
    #[error(transparent)]
    Write(#[from] ExportError),
}

/// As it is displayed, so that `fn main() -> Result<(), Error>` prints what people can read.
impl fmt::Debug for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Model(diagnostics)
    }
}
