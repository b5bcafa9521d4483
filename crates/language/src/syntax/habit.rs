//! What a message says, apart from whom it says it of: one habit that is wrong is shown once.

use super::diagnostic::{Diagnostic, Severity};

/// Diagnostics with equal habits differ in their locations and in the owner of the missing part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Habit<'d> {
    severity: Severity,
    /// Before and after the owner.
    message: (&'d str, &'d str),
    /// Where owners may differ, they have to be told the same.
    help: Option<&'d str>,
}

impl<'d> Habit<'d> {
    pub fn of(diagnostic: &'d Diagnostic) -> Self {
        let severity = diagnostic.severity;
        match around_owner(&diagnostic.message) {
            Some((before, _, after)) => Self { severity, message: (before, after), help: diagnostic.help.as_deref() },
            None => Self { severity, message: (&diagnostic.message, ""), help: None },
        }
    }
}

/// The owner of the missing part, in "body `crank` has no `angel`", or is not used.
pub fn owner(message: &str) -> Option<&str> {
    around_owner(message).map(|(_, owner, _)| owner)
}

fn around_owner(message: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = message.split_once('`')?;
    let (owner, after) = rest.split_once('`')?;
    (after.starts_with(" has no `") || after == " is used nowhere").then_some((before, owner, after))
}
