//! Codes of messages: a code is a kind of mistake that has one cure, with a page about it.
//!
//! The table has the codes, and `pages/` a page each, whose example is run by a test: it gives the code, and its cure
//! does not. `recorded.txt` has every number that was ever given, so that none changes its meaning.

mod table;

use std::fmt;

use serde::{Serialize, Serializer};

use super::suggest;

pub use table::Code;

/// Address of the pages on the web: GitHub shows them.
const PAGES: &str = "https://github.com/mbint/mbint/blob/main/docs/errors";

/// The model that examples of pages change: a section of an example replaces that of this model.
pub const MODEL: &str = include_str!("pages/model.yaml");

const INTRODUCTION: &str = "\
Messages about mistakes have codes, as in `error[E0401]`. A code is a kind of mistake that has one cure; `mbint explain
E0401` prints its page, and editors link to it. Codes of warnings begin with W. A number never gets another meaning.
`mbint explain --codes` prints this list.

Examples on these pages are whole models where they say so. Elsewhere their sections stand instead of those of this one:
";

/// Codes of one stage.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Beginning of all its codes, e.g. `E03`.
    pub letters: &'static str,
    /// The stage.
    pub about: &'static str,
    /// Its codes, in the order of their numbers.
    pub codes: &'static [Code],
}

/// An error whose kind of mistake has a code.
pub trait Coded {
    /// The code; `None` if nobody has made a mistake, as at an interruption.
    fn code(&self) -> Option<Code>;
}

impl Code {
    /// The code of this number, in capitals or not; the error names similar codes.
    pub fn find(text: &str) -> Result<Self, String> {
        let wanted = text.to_ascii_uppercase();
        let ids = || Self::ALL.iter().map(|code| code.id());
        Self::ALL.iter().copied().find(|code| code.id() == wanted).ok_or_else(|| {
            let block = Self::BLOCKS.iter().find(|block| wanted.starts_with(block.letters));
            let known = block.map(|block| suggest::list(&block.codes.iter().map(|code| code.id()).collect::<Vec<_>>()));
            match (known, suggest::nearest(&wanted, ids())) {
                (Some(known), _) => format!("there is no code `{wanted}`; those of its block are {known}"),
                (None, Some(near)) => format!("there is no code `{wanted}`; did you mean `{near}`?"),
                (None, None) => format!("there is no code `{wanted}`; `mbint explain --codes` lists them"),
            }
        })
    }

    /// Whether a text has the form of a code: a letter and four digits.
    pub fn is_like(text: &str) -> bool {
        let digits = text.strip_prefix(['E', 'e', 'W', 'w']);
        digits.is_some_and(|digits| digits.len() == 4 && digits.chars().all(|c| c.is_ascii_digit()))
    }

    /// The page of the book that lists all, as Markdown.
    pub fn index() -> String {
        let mut page = format!("# Codes of messages\n\n{INTRODUCTION}\n```yaml\n{MODEL}```\n");
        for block in Self::BLOCKS {
            page += &format!("\n## {}: {}\n\n| code | kind of mistake |\n|---|---|\n", block.letters, block.about);
            for code in block.codes {
                page += &format!("| [{code}]({code}.md) | {} |\n", code.title());
            }
        }
        page
    }

    /// Its page, as Markdown.
    pub fn page(self) -> String {
        format!("# {}: {}\n\n{}", self.id(), self.title(), self.text())
    }

    /// The address of its page in the book.
    pub fn href(self) -> String {
        format!("{PAGES}/{}.md", self.id())
    }
}

impl fmt::Display for Code {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.id())
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}
