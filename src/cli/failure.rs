//! Reasons why a command ended early, or one of several models was not run, in words for the user.

use super::Status;
use crate::syntax::{Code, Coded};

/// A message, the kind of mistake, and the status with which the command ends.
#[derive(Debug)]
pub(super) struct Failure {
    status: Status,
    code: Option<Code>,
    message: String,
}

impl Failure {
    /// The command or the model has errors.
    pub fn wrong(message: impl ToString) -> Self {
        Self { status: Status::Wrong, code: None, message: message.to_string() }
    }

    /// The command was valid and failed.
    pub fn failed(message: impl ToString) -> Self {
        Self { status: Status::Failed, code: None, message: message.to_string() }
    }

    /// Simulations are left to shards.
    pub fn deferred() -> Self {
        Self { status: Status::Deferred, code: None, message: "simulations are left to shards".to_owned() }
    }

    /// Adds the code of the error that its message quotes.
    #[must_use]
    pub fn of(self, error: &impl Coded) -> Self {
        Self { code: error.code(), ..self }
    }

    pub fn is_deferred(&self) -> bool {
        self.status == Status::Deferred
    }

    pub fn code(&self) -> Option<Code> {
        self.code
    }

    pub fn message(&self) -> &str {
        &self.message
    }

    pub fn status(&self) -> Status {
        self.status
    }
}
