//! `repeat: { i: 1..6 }`: entries that are there once for each value of an index.

use std::collections::HashMap;
use std::sync::Arc;

use symdiff::formula::indices::{self, Index};

use super::Writer;
use crate::expand::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The key.
const REPEAT: &str = "repeat";

/// The key of the repeated value, where that is no mapping.
const VALUE: &str = "value";

/// Where a node is copied to: the shift of its span, and the scope of its names there.
type Place<'s> = (usize, Option<&'s Arc<Scope>>);

impl Writer<'_, '_> {
    /// A node with its repetitions written out.
    pub(super) fn node(&mut self, node: &Node, shift: usize, scope: Option<&Arc<Scope>>) -> Node {
        let span = node.span.start + shift..node.span.end + shift;
        if !self.has_room(&span) {
            return Node { span, value: Value::Scalar(Scalar::plain("0", None)) };
        }
        let value = match &node.value {
            Value::Scalar(scalar) => Value::Scalar(self.scalar(scalar, (shift, scope))),
            Value::Sequence(items) => Value::Sequence(items.iter().map(|item| self.node(item, shift, scope)).collect()),
            Value::Mapping(entries) => Value::Mapping(self.repeated(entries, shift, scope)),
        };
        Node { span, value }
    }

    fn scalar(&mut self, scalar: &Scalar, (shift, scope): Place) -> Scalar {
        let mut copy = scalar.clone();
        copy.start = copy.start.map(|start| start + shift);
        let counts = scalar.text.contains("sum(") || scalar.text.contains('{');
        copy.scope = match scope {
            Some(scope) => Some(Arc::clone(scope)),
            None if counts => Some(Arc::clone(&self.model)),
            None => scalar.scope.clone(),
        };
        if let Some(scope) = copy.scope.clone().filter(|_| counts) {
            self.note_counts(&scalar.text, &scope);
        }
        copy
    }

    /// Notes the parameters that say how often something is repeated.
    fn note_counts(&mut self, text: &str, scope: &Scope) {
        let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty());
        let counts = words.filter(|word| scope.count(word).is_some());
        self.parts.counts.extend(counts.map(|count| scope.full(count)));
    }

    /// Entries with their repetitions written out, each at the position of the one that is repeated.
    pub(super) fn repeated(&mut self, entries: &[Entry], shift: usize, scope: Option<&Arc<Scope>>) -> Vec<Entry> {
        let mut written: Vec<Entry> = Vec::with_capacity(entries.len());
        let mut places: HashMap<String, Span> = HashMap::new();
        for entry in entries {
            let first = written.len();
            match entry.value.get(REPEAT) {
                Some(repeat) => self.copies(entry, repeat, (shift, scope), &mut written),
                None => written.extend(self.entry(entry, &entry.value, shift, scope)),
            }
            for copy in written.split_off(first) {
                match places.get(&copy.key).cloned() {
                    Some(known) => self.twice(&copy.key, &copy.key_span, &known),
                    None => {
                        places.insert(copy.key.clone(), copy.key_span.clone());
                        written.push(copy);
                    }
                }
            }
        }
        written
    }

    /// An entry with a value, copied; `None` if the braces of its name are wrong, which is reported.
    fn entry(&mut self, entry: &Entry, value: &Node, shift: usize, scope: Option<&Arc<Scope>>) -> Option<Entry> {
        let key_span = entry.key_span.start + shift..entry.key_span.end + shift;
        let value = self.node(value, shift, scope);
        let key = match scope.filter(|_| entry.key.contains('{')) {
            None => entry.key.clone(),
            Some(scope) => {
                self.note_counts(&entry.key, scope);
                match indices::fill(&entry.key, &|name| scope.whole(name)) {
                    Ok(key) => key,
                    Err(error) => {
                        let verbatim = key_span.len() == entry.key.len();
                        let part = key_span.start + error.span.start..key_span.start + error.span.end;
                        self.report.error(
                            Code::BadRepetition,
                            if verbatim { part } else { key_span },
                            error.message,
                            error.help,
                        );
                        return None;
                    }
                }
            }
        };
        Some(Entry { key, key_span, value })
    }

    /// The copies of an entry.
    fn copies(&mut self, entry: &Entry, repeat: &Node, (shift, scope): Place, written: &mut Vec<Entry>) {
        let outer = scope.map_or_else(|| Arc::clone(&self.model), Arc::clone);
        let Some(scopes) = self.scopes(repeat, shift, outer) else { return };
        let value = without_repeat(&entry.value);
        let many = scopes.len() > 1;
        for scope in scopes {
            if self.is_full {
                return;
            }
            let Some(copy) = self.entry(entry, &value, shift, Some(&scope)) else { return };
            let is_named = copy.key != entry.key;
            let span = copy.key_span.clone();
            written.push(copy);
            if many && !is_named {
                if !entry.key.contains('{') {
                    let key = clip(&entry.key);
                    let help = format!("put the index into the name, in braces: `{key}_{{i}}`");
                    self.report.error(Code::BadRepetition, span, format!("all copies are called `{key}`"), help);
                }
                return;
            }
        }
    }

    /// A scope for each value of the indices, the last index running fastest.
    fn scopes(&mut self, repeat: &Node, shift: usize, outer: Arc<Scope>) -> Option<Vec<Arc<Scope>>> {
        let span = repeat.span.start + shift..repeat.span.end + shift;
        let Value::Mapping(entries) = &repeat.value else {
            let message = format!("`{REPEAT}` is a mapping of indices, but here is {}", repeat.kind());
            self.report.error(Code::BadRepetition, span, message, "e.g. `repeat: { i: 1..6 }`".to_owned());
            return None;
        };
        let mut scopes = vec![outer];
        for entry in entries {
            let place = Entry { key_span: entry.key_span.start + shift..entry.key_span.end + shift, ..entry.clone() };
            if !self.report.is_name(&place.key, &place.key_span, "an index") {
                return None;
            }
            let mut next = Vec::new();
            for scope in &scopes {
                let values = self.values(&entry.value, shift, scope)?;
                if next.len() + values.len() > TUNING.copies {
                    let message = format!("`{REPEAT}` makes more than {copies} copies", copies = TUNING.copies);
                    self.report.error(Code::TooLarge, span, message, None);
                    return None;
                }
                next.extend(values.into_iter().map(|value| Arc::new(scope.with(&entry.key, value))));
            }
            scopes = next;
        }
        Some(scopes)
    }

    /// The values of an index: a range, or a list of words.
    fn values(&mut self, node: &Node, shift: usize, scope: &Scope) -> Option<Vec<Index>> {
        let span = node.span.start + shift..node.span.end + shift;
        if let Value::Sequence(items) = &node.value {
            if items.is_empty() {
                self.report.error(
                    Code::BadRepetition,
                    span,
                    "an index needs a value",
                    "e.g. `[left, right]`".to_owned(),
                );
                return None;
            }
            let word = |item: &Node| {
                let text = self.report.scalar(&item.moved(shift), "a number or a word")?.text.clone();
                Some(text.parse().map_or(Index::Word(text), Index::Number))
            };
            return items.iter().map(word).collect();
        }
        let node = node.moved(shift);
        let scalar = self.report.scalar(&node, "a range, such as `1..6`, or a list of words")?;
        self.note_counts(&scalar.text, scope);
        let range = match indices::range(&scalar.text, &|name| scope.whole(name)) {
            Ok(range) => range,
            Err(error) => {
                self.report.error(Code::BadRepetition, scalar.place(&node.span, error.span), error.message, error.help);
                return None;
            }
        };
        if range.end().saturating_sub(*range.start()) >= TUNING.copies as i64 {
            let message = format!("`{}` makes more than {} copies", clip(&scalar.text), TUNING.copies);
            self.report.error(Code::TooLarge, span, message, None);
            return None;
        }
        Some(range.map(Index::Number).collect())
    }

    /// The scenes, with the repetitions in their sections written out.
    pub(super) fn scenes(&mut self, node: &Node) -> Node {
        let mut scenes = self.node(node, 0, None);
        let Value::Mapping(entries) = &mut scenes.value else { return scenes };
        for scene in entries {
            let Value::Mapping(sections) = &mut scene.value.value else { continue };
            let Some(parameters) = sections.iter_mut().find(|section| section.key == "parameters") else { continue };
            let Value::Mapping(changes) = &mut parameters.value.value else { continue };
            self.refuse_counts(changes);
        }
        scenes
    }

    /// Reports parameters that are changed where nothing can be repeated anew.
    fn refuse_counts(&mut self, changes: &[Entry]) {
        for change in changes.iter().filter(|change| self.model.count(&change.key).is_some()) {
            if self.parts.counts.contains(&change.key) {
                let message = format!("a scene cannot change how often `{}` repeats something", clip(&change.key));
                let help = "`--set` can; or make it a model of its own".to_owned();
                self.report.error(Code::BadRepetition, change.key_span.clone(), message, help);
            }
        }
    }
}

/// The repeated node: the mapping without `repeat`, or the node behind `value` where nothing else is there.
fn without_repeat(node: &Node) -> Node {
    let Value::Mapping(entries) = &node.value else { return node.clone() };
    let rest: Vec<Entry> = entries.iter().filter(|entry| entry.key != REPEAT).cloned().collect();
    match rest.as_slice() {
        [only] if only.key == VALUE => only.value.clone(),
        _ => Node { span: node.span.clone(), value: Value::Mapping(rest) },
    }
}
