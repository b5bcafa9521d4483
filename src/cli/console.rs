//! The terminal, or what stands in for it: text for people and errors.

use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Style};

use super::Failure;

/// Headings.
pub(super) const BOLD: Style = Style::new().bold();
const YELLOW: Style = AnsiColor::Yellow.on_default().bold();
const RED: Style = AnsiColor::Red.on_default().bold();

/// Standard output and standard error.
#[derive(Debug, Default)]
pub(super) struct Console {
    /// Whoever read standard output has gone (`mbint … | head -1`).
    closed: bool,
}

impl Console {
    /// Writes to standard output as it stands. A reader who has read enough and closed the pipe is no failure: what
    /// comes after is dropped.
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

    /// An error's one line on standard error.
    pub fn error(&self, message: &str) {
        self.complain(&format!("{RED}error{RED:#}: {message}\n"));
    }

    /// A warning's one line on standard error.
    pub fn warning(&self, message: &str) {
        self.complain(&format!("{YELLOW}warning{YELLOW:#}: {message}\n"));
    }

    /// Text as it stands to standard error. If that is closed there is no one left to tell.
    pub fn complain(&self, text: &str) {
        let _ = anstream::stderr().lock().write_all(text.as_bytes());
    }

    /// Whether standard error shows colours.
    pub fn color(&self) -> bool {
        anstream::AutoStream::choice(&io::stderr()) != anstream::ColorChoice::Never
    }
}

/// Names of files or folders without what leads to them, in a line.
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
