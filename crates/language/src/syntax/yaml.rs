//! YAML text → a tree of nodes with their locations.
//!
//! A model file uses YAML's scalars, sequences and mappings in one document. Anchors, aliases, tags and several
//! documents are refused: people read a model, and read it as it is written.

use std::collections::HashMap;

use granit_parser::{ErrorKind, Event, Parser, ScalarStyle, options};

use super::codes::Code;
use super::commas::{join_items, join_values};
use super::diagnostic::{Diagnostic, Diagnostics};
use super::not_yaml;
use super::source::Span;
use super::suggest::clip;
pub use super::tree::{Entry, Node, Scalar, Value};
use crate::syntax::tuning::TUNING;

/// Reads one document from a text whose first byte has offset 0; `None` if there is no usable tree.
pub fn parse(text: &str, diagnostics: &mut Diagnostics) -> Option<Node> {
    let options = options! {
        emit_comments: false,
        emit_unresolved_aliases: true,
        emit_anchor_events: true,
        flow_nesting_limit: TUNING.yaml_depth,
        block_nesting_limit: TUNING.yaml_depth,
    };
    let mut builder = Builder { text, diagnostics, open: Vec::new(), root: None, is_unnamed: false };
    for (count, next) in Parser::new_from_str_with_options(text, options).enumerate() {
        let (event, span) = match next {
            Ok((event, span)) => (event, span.byte_range().unwrap_or(0..0)),
            Err(error) => {
                let at = error.marker().byte_offset().unwrap_or(text.len());
                builder.syntax_error(at, error.kind());
                return None;
            }
        };
        if count > TUNING.yaml_events {
            let message = format!("the file has more than {yaml_events} entries", yaml_events = TUNING.yaml_events);
            builder.diagnostics.push(Diagnostic::error(Code::TooLarge, span, message));
            return None;
        }
        if !builder.event(event, span) {
            return None;
        }
    }
    if builder.root.is_none() {
        builder.diagnostics.push(
            Diagnostic::of_file(Code::EmptyFile, "the file is empty")
                .help("`mbint new NAME` writes a model to begin with".to_owned()),
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
    /// Whether a key is no name, so that reading stops.
    is_unnamed: bool,
}

impl Builder<'_, '_> {
    fn error(&mut self, code: Code, span: Span, message: &str, help: &str) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help.to_owned()));
    }

    fn syntax_error(&mut self, at: usize, kind: &ErrorKind) {
        let mut at = at.min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        let span = at..at + self.text[at..].chars().next().map_or(0, char::len_utf8);
        let diagnostic = match kind {
            ErrorKind::RecursionLimitExceeded => Diagnostic::error(
                Code::TooLarge,
                span,
                format!("mappings and lists nest deeper than {yaml_depth} levels", yaml_depth = TUNING.yaml_depth),
            ),
            kind => Diagnostic::error(Code::NotYaml, span, format!("this is not YAML: {kind}")),
        };
        self.diagnostics.push(diagnostic.help(not_yaml::help(self.text, at, kind)));
    }

    /// Handles one event. Returns whether to continue.
    fn event(&mut self, event: Event, span: Span) -> bool {
        if event.tag().is_some() {
            self.error(Code::UnsupportedYaml, span.clone(), "tags are not supported", "leave the `!…` out");
        }
        match event {
            Event::DocumentStart(..) if self.root.is_some() => {
                self.error(
                    Code::UnsupportedYaml,
                    span,
                    "the file has several documents",
                    "a model is one document: remove the `---`",
                );
                return false;
            }
            Event::Anchor(..) => self.error(
                Code::UnsupportedYaml,
                span,
                "anchors are not supported",
                "make a value that is used several times a parameter, and use its name",
            ),
            Event::Alias(_) | Event::UnresolvedAlias(_) => {
                self.error(
                    Code::UnsupportedYaml,
                    span.clone(),
                    "aliases are not supported",
                    "make a value that is used several times a parameter, and use its name; a product is `a * b`",
                );
                let scalar = Scalar::plain(String::new(), None);
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
        if self.open.len() > TUNING.yaml_depth {
            self.syntax_error(self.start_of_innermost(), &ErrorKind::RecursionLimitExceeded);
            return false;
        }
        !self.is_unnamed
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
            scope: None,
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
                            let is_doubled = self.text[node.span.start..].starts_with('{');
                            let help = if is_doubled {
                                "a key is a name; write one pair of braces, `{ name: … }`"
                            } else {
                                "a key is a name"
                            };
                            self.diagnostics.push(
                                Diagnostic::error(
                                    Code::BadKey,
                                    node.span.clone(),
                                    format!("{} cannot be a key", node.kind()),
                                )
                                .help(help.to_owned()),
                            );
                            self.is_unnamed = true;
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
                let items = self.whole_items(start, items);
                Node { span: start..self.trimmed(start, end), value: Value::Sequence(items) }
            }
            Some(Open::Mapping { start, entries, .. }) => {
                let entries = self.whole_values(start, entries);
                let entries = self.without_duplicates(entries);
                Node { span: start..self.trimmed(start, end), value: Value::Mapping(entries) }
            }
            None => return,
        };
        self.add(node);
    }

    /// The items; in brackets, those that a comma has cut are joined.
    fn whole_items(&mut self, start: usize, items: Vec<Node>) -> Vec<Node> {
        let flow = self.text.get(start..).is_some_and(|text| text.starts_with('['));
        if flow { join_items(self.text, items, self.diagnostics) } else { items }
    }

    /// The entries; in braces, those that a comma has cut are joined.
    fn whole_values(&mut self, start: usize, entries: Vec<Entry>) -> Vec<Entry> {
        let flow = self.text.get(start..).is_some_and(|text| text.starts_with('{'));
        if flow { join_values(self.text, entries, self.diagnostics) } else { entries }
    }

    /// The end of a collection without the space after it: a block ends where the next one begins.
    fn trimmed(&self, start: usize, end: usize) -> usize {
        self.text.get(start..end).map_or(end, |text| start + text.trim_end().len())
    }

    fn without_duplicates(&mut self, entries: Vec<Entry>) -> Vec<Entry> {
        let mut first_places: HashMap<String, Span> = HashMap::new();
        let mut unique = Vec::with_capacity(entries.len());
        for entry in entries {
            match first_places.get(&entry.key) {
                Some(first) => self.diagnostics.push(
                    Diagnostic::error(
                        Code::GivenTwice,
                        entry.key_span,
                        format!("`{}` is given twice", clip(&entry.key)),
                    )
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
    fn nodes_have_spans() {
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
    fn unsupported_syntax_is_refused_with_its_span() {
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
    fn formula_cut_at_its_commas_is_reported_once() {
        for (text, formula) in [
            ("{ a: max(1, 2), b: 3 }", "max(1, 2)"),
            ("{ a: if(x, 0, 0), b: 3 }", "if(x, 0, 0)"),
            ("a: [1, atan2(y, max(x, 2)), 3]", "atan2(y, max(x, 2))"),
            ("{ a: [max(1, 2)] }", "max(1, 2)"),
            ("a: { b: 2*min(1,2) , c: 1 }", "2*min(1,2)"),
        ] {
            let mut diagnostics = Diagnostics::new("test", text);
            let root = parse(text, &mut diagnostics).unwrap();
            let found: Vec<_> = diagnostics.iter().collect();
            assert_eq!(found.len(), 1, "{text}: {diagnostics}");
            assert_eq!(&text[found[0].span.clone().unwrap()], formula);
            assert_eq!(found[0].help.as_deref(), Some(&*format!("quote the formula: `\"{formula}\"`")));
            let mut nodes = vec![&root];
            let mut texts = Vec::new();
            while let Some(node) = nodes.pop() {
                match &node.value {
                    Value::Scalar(scalar) => texts.push(scalar.text.clone()),
                    Value::Sequence(items) => nodes.extend(items),
                    Value::Mapping(entries) => nodes.extend(entries.iter().map(|entry| &entry.value)),
                }
            }
            assert!(texts.iter().any(|text| text == formula), "{text}: {texts:?}");
        }
        for text in ["{ a: \"max(1, 2)\" }", "a: max(1, 2)", "- max(1, 2)", "{ a: (1 }", "[ (, { b: 1 } ]"] {
            assert_eq!(errors(text), [], "{text}");
        }
    }

    #[test]
    fn an_interval_with_a_unit_is_quoted() {
        for text in ["a: [1, 2] m", "a: [1, 2] m\nb: 1", "{ a: [1, 2] m, b: 3 }", "p:\n  a: [1, 2] N/m  # so\n  b: 1"] {
            let mut diagnostics = Diagnostics::new("test", text);
            parse(text, &mut diagnostics);
            let help = diagnostics.iter().next().and_then(|found| found.help.clone());
            assert!(
                help.is_some_and(|help| help.starts_with("quote the interval: `\"[1, 2] ")),
                "{text}: {diagnostics}"
            );
        }
    }

    #[test]
    fn a_name_with_an_index_is_quoted_within_braces() {
        for text in ["a: { b_{i}: 1 }", "a: [b_{i}, c]", "c: 1\na: { d: 1, b_{i}: { e: 1 } }"] {
            let mut diagnostics = Diagnostics::new("test", text);
            parse(text, &mut diagnostics);
            let help = diagnostics.iter().next().and_then(|found| found.help.clone());
            assert!(help.is_some_and(|help| help.ends_with("`\"b_{i}\"`")), "{text}: {diagnostics}");
        }
        assert_eq!(errors("b_{i}: { a: 1 }"), []);
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
