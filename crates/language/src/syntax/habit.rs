//! Messages without their owners: a mistake that is made again and again is shown once.

use super::diagnostic::{Diagnostic, Severity};

/// Diagnostics with equal habits differ only in their locations and in the owner of the missing part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Habit<'d> {
    severity: Severity,
    /// Text before and after the owner.
    message: (&'d str, &'d str),
    /// The help, which must be equal if owners may differ; `None` for other messages.
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

/// The owner of the missing part in "body `crank` has no `angel`", or the name that is used nowhere.
pub fn owner(message: &str) -> Option<&str> {
    around_owner(message).map(|(_, owner, _)| owner)
}

fn around_owner(message: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = message.split_once('`')?;
    let (owner, after) = rest.split_once('`')?;
    (after.starts_with(" has no `") || after == " is used nowhere").then_some((before, owner, after))
}
