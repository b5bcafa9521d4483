//! Errors between a file and its bounds.

use std::fmt;

use crate::applications::{AllocateError, CostError, DataError, DesignError, FitError, VerifyError};
use crate::export::ExportError;
use crate::model::{UnknownScene, WitnessError};
use crate::study::{GradientError, RunError};
use crate::syntax::{Code, Coded, Diagnostics};

/// Reasons why there is no model, or nothing of it could be run.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The model has errors: all of them, each with its location.
    #[error("{0}")]
    Model(#[source] Diagnostics),
    /// The model does not have the scene.
    #[error(transparent)]
    Scene(#[from] UnknownScene),
    /// The mechanism cannot be built, assembled or stepped.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The model has nothing that could be allocated.
    #[error("{0}")]
    Unsuitable(String),
    /// The reference of a study of costs cannot be computed.
    #[error(transparent)]
    Cost(Box<CostError>),
    /// A point to be sampled, given by its index, does not have a finite value for each of the uncertain parameters.
    #[error("point {index} needs a finite value for each of {}", .parameters.join(", "))]
    Point {
        /// Index of the point.
        index: usize,
        /// Names of the uncertain parameters, in their order.
        parameters: Vec<String>,
    },
    /// Functions and values are not those of the model.
    #[error(transparent)]
    Witness(#[from] WitnessError),
    /// A setting of a study, such as its time step, is outside of its range.
    #[error("{0}")]
    Setting(String),
    /// A stop was requested before there was a result.
    #[error("interrupted before there were results")]
    Interrupted,
    /// Outputs have no derivatives by the parameters.
    #[error(transparent)]
    Gradient(#[from] Box<GradientError>),
    /// The model cannot be verified.
    #[error(transparent)]
    Verify(Box<VerifyError>),
    /// Measured values cannot be used.
    #[error(transparent)]
    Data(#[from] DataError),
    /// There is no fit.
    #[error(transparent)]
    Fit(Box<FitError>),
    /// There is no design.
    #[error(transparent)]
    Design(Box<DesignError>),
    /// The files could not be written.
    #[error(transparent)]
    Write(#[from] ExportError),
}

/// The display text, so that `fn main() -> Result<(), Error>` prints a readable message.
impl fmt::Debug for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

impl Error {
    /// The code of the kind of mistake, e.g. `E0901`, of which `mbint explain` has a page: that of the first error for
    /// a model with errors; `None` after an interruption.
    pub fn code(&self) -> Option<&'static str> {
        let code = match self {
            Self::Model(diagnostics) => diagnostics.code(),
            Self::Scene(error) => error.code(),
            Self::Run(error) => error.code(),
            Self::Unsuitable(_) => Some(Code::Unsuitable),
            Self::Cost(error) => error.code(),
            Self::Witness(error) => error.code(),
            Self::Setting(_) => Some(Code::OutOfRange),
            Self::Point { .. } => Some(Code::BadOverride),
            Self::Interrupted => None,
            Self::Gradient(error) => error.code(),
            Self::Verify(error) => error.code(),
            Self::Data(error) => error.code(),
            Self::Fit(error) => error.code(),
            Self::Design(error) => error.code(),
            Self::Write(error) => error.code(),
        };
        code.map(Code::id)
    }
}

impl From<AllocateError> for Error {
    fn from(error: AllocateError) -> Self {
        match error {
            AllocateError::Unsuitable(message) => Self::Unsuitable(message),
            AllocateError::Run(error) => Self::Run(error),
        }
    }
}

impl From<VerifyError> for Error {
    fn from(error: VerifyError) -> Self {
        match error {
            VerifyError::Run(error) => Self::Run(error),
            VerifyError::Interrupted => Self::Interrupted,
            VerifyError::NoSteps(_) => Self::Verify(Box::new(error)),
        }
    }
}

impl From<FitError> for Error {
    fn from(error: FitError) -> Self {
        match error {
            FitError::Run(error) => Self::Run(error),
            FitError::Interrupted => Self::Interrupted,
            error => Self::Fit(Box::new(error)),
        }
    }
}

impl From<DesignError> for Error {
    fn from(error: DesignError) -> Self {
        match error {
            DesignError::Run(error) => Self::Run(error),
            DesignError::Unsuitable(message) => Self::Unsuitable(message),
            DesignError::Interrupted => Self::Interrupted,
            error => Self::Design(Box::new(error)),
        }
    }
}

impl From<CostError> for Error {
    fn from(error: CostError) -> Self {
        match error {
            CostError::Run(error) => Self::Run(error),
            error => Self::Cost(Box::new(error)),
        }
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Model(diagnostics)
    }
}
