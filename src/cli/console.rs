//! Standard output and standard error: text for people, JSON, errors.
//!
//! This is the one way to the terminal. Texts contain names from files, which could contain control sequences; they are
//! made harmless here. Styles are therefore not in a text as the terminal's own sequences but as marks, which become
//! those afterwards.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Style};
use serde::Serialize;

use super::{Failure, Status};
use crate::overview::{Mark, RED, YELLOW};
use crate::syntax::{Code, Coded, Diagnostics, Record, harmless, is_harmful};

pub(super) use crate::overview::{BOLD, coordinates, count};

/// A text for the terminal: harmless, marks as styles.
fn styled(text: &str) -> String {
    let mut styled = String::with_capacity(text.len());
    for c in harmless(text).chars() {
        match Mark::of(c) {
            None => styled.push(c),
            Some(YELLOW) => styled += &AnsiColor::Yellow.on_default().bold().to_string(),
            Some(RED) => styled += &AnsiColor::Red.on_default().bold().to_string(),
            Some(BOLD) => styled += &Style::new().bold().to_string(),
            Some(_) => styled += &format!("{:#}", Style::new().bold()),
        }
    }
    styled
}

/// Standard output and standard error.
#[derive(Debug, Default)]
pub(super) struct Console {
    /// Whether the reader of standard output has closed the pipe (`mbint … | head -1`).
    closed: bool,
    /// Whether something could not be written.
    failed: bool,
    /// The code of the first error.
    first: Cell<Option<Code>>,
    /// Mistakes already written, where each is written once: lines and help may have other values.
    written: Option<RefCell<BTreeSet<String>>>,
}

impl Console {
    /// Writes text to standard output. A closed pipe is not a failure: further text is dropped.
    pub fn print(&mut self, text: &str) -> Result<(), Failure> {
        if self.closed {
            return Ok(());
        }
        let mut stdout = anstream::stdout().lock();
        match stdout.write_all(styled(text).as_bytes()).and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            Err(error) => {
                // The following models run nevertheless.
                self.closed = true;
                self.failed = true;
                self.error(&format!("cannot write to standard output: {error}"));
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Whether writing to standard output failed.
    pub fn has_failed(&self) -> bool {
        self.failed
    }

    /// Writes an error in one line to standard error.
    pub fn error(&self, message: &str) {
        self.coded_error(None, message);
    }

    /// Writes an error with its code, if it has one.
    pub fn coded_error(&self, code: Option<Code>, message: &str) {
        let shown = code.map_or_else(String::new, |code| format!("[{code}]"));
        self.first.set(self.first.get().or(code));
        self.report(&format!("{RED}error{shown}{RED:#}: {message}\n"));
    }

    /// Writes the reason why a command ended early; returns the exit status.
    pub fn failure(&self, failure: &Failure) -> Status {
        // The next step is printed once for all models.
        if !failure.is_deferred() {
            self.coded_error(failure.code(), failure.message());
        }
        failure.status()
    }

    /// Names the page of the first error that has one.
    pub fn more(&self) {
        if let Some(code) = self.first.get() {
            self.note(&format!("more: mbint explain {code}\n"));
        }
    }

    /// Writes a warning in one line to standard error.
    pub fn warning(&self, message: &str) {
        self.coded_warning(None, message);
    }

    /// Writes a warning with its code, if it has one.
    pub fn coded_warning(&self, code: Option<Code>, message: &str) {
        let shown = code.map_or_else(String::new, |code| format!("[{code}]"));
        self.report(&format!("{YELLOW}warning{shown}{YELLOW:#}: {message}\n"));
    }

    /// Writes a text for people to standard error.
    pub fn note(&self, text: &str) {
        self.report(text);
    }

    /// Suppresses repeated errors and warnings of a file from now on: the file is read many times.
    pub fn without_repetition(&mut self) {
        self.written = Some(RefCell::default());
    }

    /// Writes errors and warnings of a file to standard error.
    pub fn diagnostics(&self, diagnostics: &Diagnostics) {
        let color = anstream::AutoStream::choice(&io::stderr()) != anstream::ColorChoice::Never;
        // They are harmless, and have colours of their own.
        let text = diagnostics.render(color);
        self.first.set(self.first.get().or_else(|| diagnostics.code()));
        let mistakes = || {
            let of_record = |record: Record| format!("{}:{:?}: {}\n", record.file, record.line, record.message);
            diagnostics.records().into_iter().map(of_record).collect::<String>()
        };
        if self.written.as_ref().is_none_or(|written| written.borrow_mut().insert(mistakes())) {
            let _ = anstream::stderr().lock().write_all(text.as_bytes());
        }
    }

    /// Writes text to standard error; nothing can be reported if that is closed.
    fn report(&self, text: &str) {
        let _ = anstream::stderr().lock().write_all(styled(text).as_bytes());
    }
}

/// Names of files or folders without their paths, in a line.
pub(super) fn file_names<'p>(paths: impl IntoIterator<Item = &'p PathBuf>) -> String {
    let names = paths.into_iter().filter_map(|path| path.file_name()).map(|name| name.to_string_lossy());
    names.collect::<Vec<_>>().join(", ")
}

/// Indented JSON with a line end; control characters of a terminal are escaped.
pub(super) fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    let text = text.map_err(|error| Failure::failed(format!("cannot write JSON: {error}")))?;
    let mut escaped = String::with_capacity(text.len() + 1);
    for c in text.chars() {
        match c {
            // These occur within strings only, and are below U+10000.
            c if is_harmful(c) => escaped += &format!("\\u{:04x}", u32::from(c)),
            c => escaped.push(c),
        }
    }
    Ok(escaped + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overview::plain;

    #[test]
    fn only_marks_become_styles() {
        let text = styled(&format!("{BOLD}a\u{1b}[31m{BOLD:#}\n"));
        assert_eq!(text, "\u{1b}[1ma\u{fffd}[31m\u{1b}[0m\n");
        assert_eq!(plain(&format!("{RED}error{RED:#}: x")), "error: x");
    }

    #[test]
    fn json_keeps_names() {
        let text = to_json(&"a\u{9b}\u{202e}\u{1b}").unwrap();
        assert_eq!(text, "\"a\\u009b\\u202e\\u001b\"\n");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), "a\u{9b}\u{202e}\u{1b}");
    }
}
