//! Why a point has no answer, in words for the user.

use super::tuning::TUNING;
use std::fmt;

/// Why a point has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Trouble {
    /// The process ended.
    #[error("the program ended ({status}) without an answer{words}")]
    Ended {
        /// Exit status, for people.
        status: String,
        /// Its last words.
        words: Words,
    },
    /// It took longer than it may.
    #[error("the program did not answer within {limit} s, and was ended{words}")]
    TooSlow {
        /// Limit of the call, s.
        limit: f64,
        /// Its last words.
        words: Words,
    },
    /// It wrote much more than its answers take.
    #[error("the program wrote more than {most} bytes without an end of its answers, and was ended{words}")]
    TooMuch {
        /// Bytes that a call may take.
        most: u64,
        /// Its last words.
        words: Words,
    },
    /// The program itself says that it failed.
    #[error("the program says: {}", clipped(text))]
    Said {
        /// In its words.
        text: String,
    },
    /// A line cannot be read.
    #[error("`{}` is no answer: {why}", clipped(line))]
    Unreadable {
        /// The line.
        line: String,
        /// Its fault.
        why: String,
    },
    /// An output is missing.
    #[error("the answer has no output `{name}`; it has {found}")]
    NoOutput {
        /// Its name.
        name: String,
        /// Names of the outputs in the answer, or `none`.
        found: String,
    },
    /// There are too few rows, or too many.
    #[error("the answer has {found} {name} where {wanted} were asked for")]
    Rows {
        /// For people: ``rows of `x` ``.
        name: String,
        /// Number of rows found.
        found: usize,
        /// Number of rows wanted.
        wanted: usize,
    },
    /// A row is of another time.
    #[error("row {row} of the answer is at t = {} s, but {} s was asked for", tidy(*found), tidy(*wanted))]
    Time {
        /// From 0.
        row: usize,
        /// s
        found: f64,
        /// s
        wanted: f64,
    },
    /// A value is no number.
    #[error("`{name}` is not a finite number at t = {} s", tidy(*time))]
    NotFinite {
        /// The output.
        name: String,
        /// s
        time: f64,
    },
}

/// The end of a process's standard error, of which the last line is shown; nothing if it is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words(pub String);

impl fmt::Display for Words {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        // The end of a traceback states the error; lines of marks under a word do not.
        let has_words = |line: &&str| line.contains(|c: char| c.is_alphanumeric());
        let Some(last) = self.0.lines().map(str::trim).rfind(has_words) else { return Ok(()) };
        write!(f, "; its last words: {}", clipped_front(last))
    }
}

/// A time without the last digits' rounding.
fn tidy(time: f64) -> f64 {
    format!("{time:.12e}").parse().unwrap_or(time)
}

fn clipped(text: &str) -> String {
    let text = harmless(text);
    match text.char_indices().nth(TUNING.shown_characters) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// The last characters.
fn clipped_front(text: &str) -> String {
    let text = harmless(text);
    let beyond = text.chars().count().saturating_sub(TUNING.shown_characters);
    if beyond == 0 { text } else { format!("…{}", text.chars().skip(beyond).collect::<String>()) }
}

/// On one line, and saying nothing to the terminal.
fn harmless(text: &str) -> String {
    text.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
