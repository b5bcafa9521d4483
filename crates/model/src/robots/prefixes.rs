//! Prefixes of other programs that a file uses without declaring them, as exporters of robots write them.

use roxmltree::Error;

use super::budget::SKIPPED;
use crate::robots::tuning::TUNING;

/// Prefixes that are no other program's: to leave them undeclared is a mistake.
const OWN: [&str; 2] = ["mbint", "xacro"];

/// A text with more declarations, and where they were put in.
pub struct WithPrefixes {
    pub text: String,
    /// Offset of the first byte.
    pub at: usize,
    /// Bytes.
    pub length: usize,
}

/// The text with a declaration of each prefix that another program's parts have without one; `None` if its first error
/// is another.
pub fn declared(text: &str, first: &Error, error_of: fn(&str) -> Option<Error>) -> Option<WithPrefixes> {
    let at = name_end(text)?;
    let mut prefixes: Vec<String> = vec![foreign(first)?];
    loop {
        let declare = |prefix: &String| format!(" xmlns:{prefix}=\"urn:undeclared:{prefix}\"");
        let declarations: String = prefixes.iter().map(declare).collect();
        let whole = format!("{}{declarations}{}", &text[..at], &text[at..]);
        match error_of(&whole).as_ref().and_then(foreign) {
            Some(prefix) if prefixes.len() < TUNING.xml_prefixes => prefixes.push(prefix),
            _ => return Some(WithPrefixes { text: whole, at, length: declarations.len() }),
        }
    }
}

fn foreign(error: &Error) -> Option<String> {
    match error {
        Error::UnknownNamespace(prefix, _) if !OWN.contains(&prefix.as_str()) => Some(prefix.clone()),
        _ => None,
    }
}

/// Where the name of the outermost element ends.
fn name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        let open = at + text[at..].find('<')?;
        let Some((begin, end)) = SKIPPED.iter().find(|(begin, _)| text[open..].starts_with(begin)) else {
            let name = &text[open + 1..];
            return Some(open + 1 + name.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>'))?);
        };
        let inside = open + begin.len();
        at = inside + text[inside..].find(end)? + end.len();
    }
}
