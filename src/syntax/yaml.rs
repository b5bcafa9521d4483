//! YAML text → a tree whose every node knows its place.
//!
//! Of YAML, a model file uses scalars, sequences and mappings in one document. Anchors, aliases, tags and several
//! documents are refused: a model is read by people, and what stands in a place is what is meant there.

use std::collections::HashMap;

use granit_parser::{ErrorKind, Event, Parser, ScalarStyle, options};

use super::diagnostic::{Diagnostic, Diagnostics};
use super::source::Span;
use super::suggest::clip;

/// How deep mappings and sequences may nest. The grammar needs six.
const MAX_DEPTH: usize = 40;

/// How many scalars, beginnings and ends a file may have.
const MAX_EVENTS: usize = 1_000_000;

/// A node of the tree.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its bytes.
    pub span: Span,
    /// What it is.
    pub value: Value,
}

/// What a node is.
#[derive(Clone, Debug)]
pub enum Value {
    /// A piece of text.
    Scalar(Scalar),
    /// A list.
    Sequence(Vec<Node>),
    /// Keys with values, in the order of the file.
    Mapping(Vec<Entry>),
}

/// A key with its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key's text.
    pub key: String,
    /// The key's place.
    pub key_span: Span,
    /// What stands behind the key.
    pub value: Node,
}

/// A piece of text.
#[derive(Clone, Debug)]
pub struct Scalar {
    /// The text, escapes resolved.
    pub text: String,
    /// Written without quotes.
    pub plain: bool,
    /// Where the text stands word for word in the source, if it does.
    pub start: Option<usize>,
}

impl Scalar {
    /// Nothing was written, or `null`.
    pub fn is_null(&self) -> bool {
        self.plain && matches!(self.text.as_str(), "" | "~" | "null" | "Null" | "NULL")
    }

    /// The place of a part of the text; of the whole node where escapes or line breaks stand between.
    pub fn place(&self, node: &Span, part: Span) -> Span {
        match self.start {
            Some(start) => start + part.start..start + part.end,
            None => node.clone(),
        }
    }
}

impl Node {
    /// The value of a key of a mapping.
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Mapping(entries) => entries.iter().find(|entry| entry.key == key).map(|entry| &entry.value),
            _ => None,
        }
    }

    /// The scalar, if it is one.
    pub fn scalar(&self) -> Option<&Scalar> {
        match &self.value {
            Value::Scalar(scalar) => Some(scalar),
            _ => None,
        }
    }

    /// Nothing was written, or `null`.
    pub fn is_null(&self) -> bool {
        self.scalar().is_some_and(Scalar::is_null)
    }

    /// What it is, for messages.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Scalar(scalar) if scalar.is_null() => "nothing",
            Value::Scalar(_) => "a value",
            Value::Sequence(_) => "a list",
            Value::Mapping(_) => "a mapping",
        }
    }
}

/// Reads one document from a text whose first byte has offset 0; `None` where there is no tree to go on with.
pub fn parse(text: &str, diagnostics: &mut Diagnostics) -> Option<Node> {
    let options = options! {
        emit_comments: false,
        emit_unresolved_aliases: true,
        emit_anchor_events: true,
        flow_nesting_limit: MAX_DEPTH,
        block_nesting_limit: MAX_DEPTH,
    };
    let mut builder = Builder { text, diagnostics, open: Vec::new(), root: None };
    for (count, next) in Parser::new_from_str_with_options(text, options).enumerate() {
        let (event, span) = match next {
            Ok((event, span)) => (event, span.byte_range().unwrap_or(0..0)),
            Err(error) => {
                let at = error.marker().byte_offset().unwrap_or(text.len());
                builder.syntax_error(at, error.kind());
                return None;
            }
        };
        if count > MAX_EVENTS {
            let message = format!("the file has more than {MAX_EVENTS} entries");
            builder.diagnostics.push(Diagnostic::error(span, message));
            return None;
        }
        if !builder.event(event, span) {
            return None;
        }
    }
    if builder.root.is_none() {
        builder.diagnostics.push(
            Diagnostic::of_file("the file is empty").help("`mbint new NAME` writes a model to begin with".to_owned()),
        );
    }
    builder.root
}

/// A collection that is not finished yet.
enum Open {
    Sequence { start: usize, items: Vec<Node> },
    Mapping { start: usize, entries: Vec<Entry>, key: Option<(String, Span)> },
}

struct Builder<'t, 'd> {
    text: &'t str,
    diagnostics: &'d mut Diagnostics,
    open: Vec<Open>,
    root: Option<Node>,
}

impl Builder<'_, '_> {
    fn error(&mut self, span: Span, message: &str, help: &str) {
        self.diagnostics.push(Diagnostic::error(span, message).help(help.to_owned()));
    }

    fn syntax_error(&mut self, at: usize, kind: &ErrorKind) {
        let mut at = at.min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        let span = at..at + self.text[at..].chars().next().map_or(0, char::len_utf8);
        let diagnostic = match kind {
            ErrorKind::RecursionLimitExceeded => {
                Diagnostic::error(span, format!("mappings and lists nest deeper than {MAX_DEPTH} levels"))
            }
            kind => Diagnostic::error(span, format!("this is not YAML: {kind}")),
        };
        let tab =
            self.text[..at].rsplit('\n').next().is_some_and(|line| line.trim_start_matches(' ').starts_with('\t'))
                || self.text[at..].starts_with('\t');
        let help = tab.then(|| "YAML is indented with spaces, not tabs".to_owned());
        self.diagnostics.push(diagnostic.help(help));
    }

    /// Takes one event; whether to go on.
    fn event(&mut self, event: Event, span: Span) -> bool {
        if event.tag().is_some() {
            self.error(span.clone(), "tags are not supported", "leave the `!…` out");
        }
        match event {
            Event::DocumentStart(..) if self.root.is_some() => {
                self.error(span, "the file has several documents", "a model is one document: remove the `---`");
                return false;
            }
            Event::Anchor(..) => self.error(
                span,
                "anchors are not supported",
                "name what is used several times as a parameter, and use its name",
            ),
            Event::Alias(_) | Event::UnresolvedAlias(_) => {
                self.error(
                    span.clone(),
                    "aliases are not supported",
                    "name what is used several times as a parameter, and use its name; a product is `a * b`",
                );
                let scalar = Scalar { text: String::new(), plain: true, start: None };
                self.add(Node { span, value: Value::Scalar(scalar) });
            }
            Event::Scalar(text, style, ..) => {
                let scalar = self.scalar(&text, style, &span);
                self.add(Node { span, value: Value::Scalar(scalar) });
            }
            Event::SequenceStart(..) => self.open.push(Open::Sequence { start: span.start, items: Vec::new() }),
            Event::MappingStart(..) => {
                self.open.push(Open::Mapping { start: span.start, entries: Vec::new(), key: None });
            }
            Event::SequenceEnd | Event::MappingEnd => self.close(span.end),
            _ => {}
        }
        if self.open.len() > MAX_DEPTH {
            self.syntax_error(self.start_of_innermost(), &ErrorKind::RecursionLimitExceeded);
            return false;
        }
        true
    }

    fn start_of_innermost(&self) -> usize {
        match self.open.last() {
            Some(Open::Sequence { start, .. } | Open::Mapping { start, .. }) => *start,
            None => 0,
        }
    }

    fn scalar(&self, text: &str, style: ScalarStyle, span: &Span) -> Scalar {
        let quotes = usize::from(matches!(style, ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted));
        let inner = span.start + quotes..span.end.saturating_sub(quotes);
        let verbatim = self.text.get(inner.clone()).is_some_and(|source| source.trim_end() == text.trim_end());
        Scalar {
            text: text.to_owned(),
            plain: matches!(style, ScalarStyle::Plain),
            start: verbatim.then_some(inner.start),
        }
    }

    fn add(&mut self, node: Node) {
        match self.open.last_mut() {
            None => self.root = Some(node),
            Some(Open::Sequence { items, .. }) => items.push(node),
            Some(Open::Mapping { entries, key, .. }) => match key.take() {
                Some((key, key_span)) => entries.push(Entry { key, key_span, value: node }),
                None => {
                    let text = match node.value {
                        Value::Scalar(scalar) => scalar.text,
                        _ => {
                            self.diagnostics.push(
                                Diagnostic::error(node.span.clone(), format!("{} cannot be a key", node.kind()))
                                    .help("a key is a name".to_owned()),
                            );
                            String::new()
                        }
                    };
                    *key = Some((text, node.span));
                }
            },
        }
    }

    fn close(&mut self, end: usize) {
        let node = match self.open.pop() {
            Some(Open::Sequence { start, items }) => {
                Node { span: start..self.trimmed(start, end), value: Value::Sequence(items) }
            }
            Some(Open::Mapping { start, entries, .. }) => {
                let entries = self.without_duplicates(entries);
                Node { span: start..self.trimmed(start, end), value: Value::Mapping(entries) }
            }
            None => return,
        };
        self.add(node);
    }

    /// The end of a collection without the space behind it: a block ends where the next one begins.
    fn trimmed(&self, start: usize, end: usize) -> usize {
        self.text.get(start..end).map_or(end, |text| start + text.trim_end().len())
    }

    fn without_duplicates(&mut self, entries: Vec<Entry>) -> Vec<Entry> {
        let mut first_places: HashMap<String, Span> = HashMap::new();
        let mut unique = Vec::with_capacity(entries.len());
        for entry in entries {
            match first_places.get(&entry.key) {
                Some(first) => self.diagnostics.push(
                    Diagnostic::error(entry.key_span, format!("`{}` is given twice", clip(&entry.key)))
                        .label("again here")
                        .also(first.clone(), "first here"),
                ),
                None => {
                    first_places.insert(entry.key.clone(), entry.key_span.clone());
                    unique.push(entry);
                }
            }
        }
        unique
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(text: &str) -> Vec<(String, Option<Span>)> {
        let mut diagnostics = Diagnostics::new("test", text);
        parse(text, &mut diagnostics);
        diagnostics.iter().map(|found| (found.message.clone(), found.span.clone())).collect()
    }

    #[test]
    fn nodes_know_their_places() {
        let text = "a: { b: [1, \"x y\"] }\nc: |\n  two\n  lines\n";
        let mut diagnostics = Diagnostics::new("test", text);
        let root = parse(text, &mut diagnostics).unwrap();
        assert!(diagnostics.is_empty());
        let Value::Mapping(entries) = &root.value else { panic!("a mapping") };
        assert_eq!(&text[entries[0].key_span.clone()], "a");
        assert_eq!(&text[entries[0].value.span.clone()], "{ b: [1, \"x y\"] }");
        let Value::Mapping(inner) = &entries[0].value.value else { panic!("a mapping") };
        let Value::Sequence(items) = &inner[0].value.value else { panic!("a list") };
        let quoted = items[1].scalar().unwrap();
        assert_eq!(&text[quoted.place(&items[1].span, 0..1)], "x");
        assert_eq!(entries[1].value.scalar().unwrap().start, None);
    }

    #[test]
    fn what_a_model_does_not_use_is_refused_in_its_place() {
        assert_eq!(errors("a: 1\na: 2"), [("`a` is given twice".to_owned(), Some(5..6))]);
        assert_eq!(errors("a: &n 1\nb: *n").len(), 2);
        assert_eq!(errors("a: *n"), [("aliases are not supported".to_owned(), Some(3..5))]);
        assert_eq!(errors("a: 1\n---\nb: 2")[0].0, "the file has several documents");
        assert_eq!(errors("a: !x 1")[0].0, "tags are not supported");
        assert_eq!(errors("? [1]\n: 2")[0].0, "a list cannot be a key");
        assert_eq!(errors("# nothing")[0].0, "the file is empty");
        assert!(errors("a: [1, 2")[0].0.starts_with("this is not YAML"));
    }

    #[test]
    fn depth_and_size_are_limited() {
        for text in ["[".repeat(100_000), "- ".repeat(100_000), "{a: ".repeat(100_000), "? ".repeat(100_000)] {
            let errors = errors(&text);
            assert_eq!(errors.len(), 1, "{errors:?}");
            assert!(errors[0].0.contains("nest deeper"), "{errors:?}");
        }
        let nested: String = (0..100_000).map(|depth| format!("{}a:\n", " ".repeat(depth % 3000))).collect();
        assert!(!errors(&nested[..10_000_000.min(nested.len())]).is_empty());
        assert!(errors(&"- a\n".repeat(1_100_000))[0].0.contains("more than 1000000"));
    }
}
