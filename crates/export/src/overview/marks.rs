//! Styles of a text for people. Texts contain names from files, so styles are not sequences of a terminal in them, but
//! marks, which become those sequences, or nothing, when the text is shown.

use std::fmt::{self, Write};

/// A style within a text: `{BOLD}` begins it, `{BOLD:#}` ends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark(char);

/// Ends every style. Marks are code points that Unicode reserves as noncharacters.
pub const END: Mark = Mark('\u{fdd0}');

/// Headings.
pub const BOLD: Mark = Mark('\u{fdd1}');

/// Warnings.
pub const YELLOW: Mark = Mark('\u{fdd2}');

/// Errors.
pub const RED: Mark = Mark('\u{fdd3}');

impl Mark {
    /// The mark that a character is, if it is one.
    pub fn of(c: char) -> Option<Self> {
        [END, BOLD, YELLOW, RED].into_iter().find(|mark| mark.0 == c)
    }
}

impl fmt::Display for Mark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_char(if formatter.alternate() { END.0 } else { self.0 })
    }
}

/// A text without its marks.
pub fn plain(text: &str) -> String {
    text.chars().filter(|c| Mark::of(*c).is_none()).collect()
}
