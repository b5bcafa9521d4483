//! Limits on the size of a file of XML, checked in one pass over its bytes before anything is parsed.
//!
//! The parsers compare each attribute of an element with all its others and descend into nested elements, so that a
//! small file could keep them busy for minutes, or exhaust their stack.

use crate::robots::tuning::TUNING;
use std::ops::Range;

/// A part with neither elements nor attributes, from its beginning to its end.
pub const SKIPPED: [(&str, &str); 3] = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];

/// Finds the first location at which a text exceeds a limit, and says which.
///
/// A text that is not XML passes: the parser reports it.
///
/// # Errors
/// The location of the element, and the message.
pub fn check(text: &str) -> Result<(), (Range<usize>, String)> {
    let (mut levels, mut elements, mut attributes) = (0_usize, 0, 0);
    let mut at = 0;
    while let Some(open) = text[at..].find('<').map(|found| at + found) {
        if let Some((begin, end)) = SKIPPED.iter().find(|(begin, _)| text[open..].starts_with(begin)) {
            let Some(found) = text[open + begin.len()..].find(end) else { return Ok(()) };
            at = open + begin.len() + found + end.len();
            continue;
        }
        if text[open..].starts_with("</") {
            levels = levels.saturating_sub(1);
            at = open + 2;
            continue;
        }
        let tag = Tag::read(&text.as_bytes()[open..]);
        elements += 1;
        attributes += tag.attributes;
        levels += 1;
        let message = if levels > TUNING.xml_levels {
            Some(format!("elements nest deeper than {xml_levels} levels", xml_levels = TUNING.xml_levels))
        } else if tag.attributes > TUNING.xml_attributes {
            Some(format!(
                "this element has more than {xml_attributes} attributes",
                xml_attributes = TUNING.xml_attributes
            ))
        } else if elements > TUNING.xml_items {
            Some(format!("the file has more than {xml_items} elements", xml_items = TUNING.xml_items))
        } else if attributes > TUNING.xml_items {
            Some(format!("the file has more than {xml_items} attributes", xml_items = TUNING.xml_items))
        } else {
            None
        };
        if let Some(message) = message {
            let name = text[open + 1..].find(|c: char| !c.is_alphanumeric()).unwrap_or(0);
            return Err((open..open + 1 + name, message));
        }
        levels -= usize::from(tag.is_empty);
        at = open + tag.length;
    }
    Ok(())
}

/// A start tag.
struct Tag {
    /// Bytes from `<` to its `>`.
    length: usize,
    attributes: usize,
    /// Whether it ends with `/>`.
    is_empty: bool,
}

impl Tag {
    /// The tag at the beginning of `bytes`; a value may contain `>`.
    fn read(bytes: &[u8]) -> Self {
        let mut attributes = 0;
        let mut quote = None;
        for (index, &byte) in bytes.iter().enumerate() {
            match (quote, byte) {
                (None, b'"' | b'\'') => {
                    quote = Some(byte);
                    attributes += 1;
                }
                (Some(open), _) if open == byte => quote = None,
                (None, b'>') => return Self { length: index + 1, attributes, is_empty: bytes[index - 1] == b'/' },
                _ => {}
            }
        }
        Self { length: bytes.len(), attributes, is_empty: false }
    }
}
