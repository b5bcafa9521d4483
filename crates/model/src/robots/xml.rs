//! Text → XML tree with locations; the parser's findings, in words.

use std::ops::Range;

use roxmltree::{Attribute, Document, Node, ParsingOptions};

use super::budget;
use super::prefixes::{self, WithPrefixes};
use crate::robots::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;

/// Namespace of mbint's own attributes.
pub const NAMESPACE: &str = "urn:mbint";

/// Help for a file with xacro.
pub const EXPAND: &str = "expand it first: `xacro robot.urdf.xacro > robot.urdf`";

pub type Element<'a, 'i> = Node<'a, 'i>;

/// Parses the text of a format (`a URDF`), which begins at offset `start` of the sources. `held` stores the text that
/// is parsed if it is another: one in which all prefixes are declared.
pub fn parse<'t>(
    text: &'t str,
    held: &'t mut String,
    start: usize,
    format: &str,
    diagnostics: &mut Diagnostics,
) -> Option<(Document<'t>, XmlSpans)> {
    let mut places = XmlSpans { start, at: 0, length: 0 };
    if let Err((place, message)) = budget::check(text) {
        diagnostics.push(Diagnostic::error(Code::BadXml, places.span(place), message));
        return None;
    }
    let mut text = text;
    let mut document = document_of(text);
    let error_of = |text: &str| document_of(text).err();
    let declared = document.as_ref().err().and_then(|error| prefixes::declared(text, error, error_of));
    if let Some(WithPrefixes { text: whole, at, length }) = declared {
        *held = whole;
        (text, places) = (held.as_str(), XmlSpans { start, at, length });
        document = document_of(text);
    }
    match document {
        Ok(document) => Some((document, places)),
        Err(error) => {
            diagnostics.push(syntax_error(text, places, format, &error));
            None
        }
    }
}

fn document_of(text: &str) -> Result<Document<'_>, roxmltree::Error> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: TUNING.xml_nodes, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
}

/// Diagnostic of the parser's error, with a suggested correction if one is known.
fn syntax_error(text: &str, places: XmlSpans, format: &str, error: &roxmltree::Error) -> Diagnostic {
    let at = error.pos();
    let line = text.split_inclusive('\n').take(at.row.saturating_sub(1) as usize).map(str::len).sum::<usize>();
    let column: usize = text[line..].chars().take(at.col.saturating_sub(1) as usize).map(char::len_utf8).sum();
    let ended = matches!(error, roxmltree::Error::UnexpectedEndOfStream);
    let offset = if ended { text.trim_end().len() } else { (line + column).min(text.len()) };
    let length = text[offset..].chars().next().map_or(0, char::len_utf8);
    let (message, help) = match error {
        roxmltree::Error::DtdDetected => {
            (format!("{format} has no document type: `<!DOCTYPE` is refused"), Some("take it out".to_owned()))
        }
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro" => (
            format!("this is xacro, not yet {}", format.rsplit(' ').next().unwrap_or_default()),
            Some(EXPAND.to_owned()),
        ),
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "mbint" => (
            "the prefix `mbint` is not declared".to_owned(),
            Some(format!("write `xmlns:mbint=\"{NAMESPACE}\"` in `<robot …>`")),
        ),
        roxmltree::Error::UnexpectedEndOfStream => ("the file ends in the middle".to_owned(), None),
        roxmltree::Error::NodesLimitReached => ("the file has too many elements".to_owned(), None),
        error => {
            // The location is shown next to it.
            let message = error.to_string();
            let message = message.rsplit_once(" at ").map_or(message.as_str(), |(message, _)| message);
            (format!("this is not XML: {}", clip(message)), None)
        }
    };
    Diagnostic::error(Code::BadXml, places.span(offset..offset + length), message).help(help)
}

/// Places of a document's parts among the sources.
#[derive(Clone, Copy)]
pub struct XmlSpans {
    /// Offset of the document's first byte.
    start: usize,
    /// Where declarations of prefixes were put in that the file does not have, and how many bytes.
    at: usize,
    length: usize,
}

impl XmlSpans {
    fn span(self, range: Range<usize>) -> Span {
        let in_file = |offset: usize| {
            let original = if offset < self.at + self.length { offset.min(self.at) } else { offset - self.length };
            self.start + original
        };
        in_file(range.start)..in_file(range.end)
    }

    /// The element's start tag: the location of an error of the whole element.
    pub fn tag(self, element: Element) -> Span {
        let range = element.range();
        let text = &element.document().input_text()[range.clone()];
        let length = text.find(['>', '\n']).map_or(text.len(), |end| end + usize::from(text[end..].starts_with('>')));
        self.span(range.start..range.start + length)
    }

    /// An attribute with its name.
    pub fn attribute(self, attribute: Attribute) -> Span {
        self.span(attribute.range())
    }

    /// The value of an attribute.
    pub fn value(self, attribute: Attribute) -> Span {
        self.span(attribute.range_value())
    }

    /// The value of an attribute; the start tag where the element does not have it.
    pub fn value_or_tag(self, element: Element, attribute: &str) -> Span {
        plain(element, attribute).map_or_else(|| self.tag(element), |attribute| self.value(attribute))
    }
}

/// The attribute of a name without prefix: with one, it is another program's.
pub fn plain<'a, 'i>(element: Element<'a, 'i>, name: &str) -> Option<Attribute<'a, 'i>> {
    element.attributes().find(|attribute| attribute.namespace().is_none() && attribute.name() == name)
}

/// The elements of a name within another, in its namespace: others' elements may have the same name.
pub fn children<'a, 'i>(element: Element<'a, 'i>, tag: &'static str) -> impl Iterator<Item = Element<'a, 'i>> {
    let namespace = element.tag_name().namespace();
    element.children().filter(move |node| {
        node.is_element() && node.tag_name().name() == tag && node.tag_name().namespace() == namespace
    })
}

/// The first of them.
pub fn child<'a, 'i>(element: Element<'a, 'i>, tag: &'static str) -> Option<Element<'a, 'i>> {
    children(element, tag).next()
}
