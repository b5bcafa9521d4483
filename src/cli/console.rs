//! Standard output and standard error: text for people, JSON, errors.

use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Style};
use serde::Serialize;

use super::Failure;

/// Headings.
pub(super) const BOLD: Style = Style::new().bold();
const YELLOW: Style = AnsiColor::Yellow.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();

/// Standard output and standard error.
#[derive(Debug, Default)]
pub(super) struct Console {
    /// Whether the reader of standard output has closed the pipe (`mbint … | head -1`).
    closed: bool,
}

impl Console {
    /// Writes text to standard output. A closed pipe is no failure: further text is dropped.
    pub fn print(&mut self, text: &str) -> Result<(), Failure> {
        if self.closed {
            return Ok(());
        }
        let mut stdout = anstream::stdout().lock();
        match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            result => result.map_err(|error| Failure::Failed(format!("cannot write to standard output: {error}"))),
        }
    }

    /// Writes an error in one line to standard error.
    pub fn error(&self, message: &str) {
        self.report(&format!("{RED}error{RED:#}: {message}\n"));
    }

    /// Writes a warning in one line to standard error.
    pub fn warning(&self, message: &str) {
        self.report(&format!("{YELLOW}warning{YELLOW:#}: {message}\n"));
    }

    /// Writes text to standard error; if that is closed, nobody can be told.
    pub fn report(&self, text: &str) {
        let _ = anstream::stderr().lock().write_all(text.as_bytes());
    }

    /// Whether standard error shows colours.
    pub fn color(&self) -> bool {
        anstream::AutoStream::choice(&io::stderr()) != anstream::ColorChoice::Never
    }
}

/// Names of files or folders without their paths, in a line.
pub(super) fn file_names<'p>(paths: impl IntoIterator<Item = &'p PathBuf>) -> String {
    let names = paths.into_iter().filter_map(|path| path.file_name()).map(|name| name.to_string_lossy());
    names.collect::<Vec<_>>().join(", ")
}

/// `1 step`, `2 steps`, `no steps`.
pub(super) fn count(n: usize, one: &str, many: &str) -> String {
    match n {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        _ => format!("{n} {many}"),
    }
}

/// Indented JSON with a line end.
pub(super) fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n").map_err(|error| Failure::Failed(format!("cannot write JSON: {error}")))
}
