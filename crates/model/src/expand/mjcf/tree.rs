//! Nodes of a model's tree that are not written in it, each with its location in the robot's file.

use crate::robots::algebra::Value;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar, Value as Tree};

pub fn text(span: &Span, text: impl Into<String>) -> Node {
    Node { span: span.clone(), value: Tree::Scalar(Scalar::plain(text, None)) }
}

pub fn list(span: &Span, items: impl IntoIterator<Item = Node>) -> Node {
    Node { span: span.clone(), value: Tree::Sequence(items.into_iter().collect()) }
}

pub fn map(span: &Span, entries: impl IntoIterator<Item = (String, Node)>) -> Node {
    let entry = |(key, value)| Entry { key, key_span: span.clone(), value };
    Node { span: span.clone(), value: Tree::Mapping(entries.into_iter().map(entry).collect()) }
}

/// A mapping of few known keys.
pub fn keys<const N: usize>(span: &Span, entries: [(&str, Node); N]) -> Node {
    map(span, entries.map(|(key, value)| (key.to_owned(), value)))
}

pub fn value(span: &Span, value: &Value) -> Node {
    text(span, value.text())
}

pub fn values<const N: usize>(span: &Span, numbers: &[Value; N]) -> Node {
    list(span, numbers.iter().map(|number| value(span, number)))
}

/// A number in SI; a formula, which is a pure number, times its unit.
pub fn in_unit(span: &Span, number: &Value, unit: &str) -> Node {
    match number {
        Value::Number(_) => value(span, number),
        Value::Text(formula) => text(span, format!("{formula} * {unit}")),
    }
}

pub fn lengths<const N: usize>(span: &Span, numbers: &[Value; N]) -> Node {
    list(span, numbers.iter().map(|number| in_unit(span, number, "1 m")))
}

/// The sections of a model's tree.
pub struct Sections(pub Vec<Entry>);

impl Sections {
    /// The entries of a section, which is created if it is absent; `None` if the section is no mapping.
    pub fn of(&mut self, section: &str, span: &Span) -> Option<&mut Vec<Entry>> {
        let known = self.0.iter().position(|entry| entry.key == section && !entry.value.is_null());
        let index = known.unwrap_or_else(|| {
            self.0.retain(|entry| entry.key != section);
            self.0.push(Entry { key: section.to_owned(), key_span: span.clone(), value: map(span, []) });
            self.0.len() - 1
        });
        match &mut self.0[index].value.value {
            Tree::Mapping(entries) => Some(entries),
            _ => None,
        }
    }

    /// Adds an entry, unless the model says something else by its name.
    pub fn add(&mut self, section: &str, name: &str, node: Node) {
        let span = node.span.clone();
        let Some(entries) = self.of(section, &span) else { return };
        if entries.iter().all(|entry| entry.key != name) {
            entries.push(Entry { key: name.to_owned(), key_span: span, value: node });
        }
    }

    /// Adds a body. An entry of the model with nothing but `points` adds these to the body, where they replace its
    /// points of the same names; any other entry of the model replaces the body.
    pub fn add_body(&mut self, name: &str, mut node: Node) {
        let Some(entries) = self.of("bodies", &node.span.clone()) else { return };
        let Some(own) = entries.iter_mut().find(|entry| entry.key == name) else {
            return self.add("bodies", name, node);
        };
        let Tree::Mapping(keys) = &mut own.value.value else { return };
        let [Entry { key, value: Node { value: Tree::Mapping(points), .. }, .. }] = keys.as_mut_slice() else { return };
        if key != "points" {
            return;
        }
        let mut points = std::mem::take(points);
        let Tree::Mapping(of_robot) = &mut node.value else { return };
        for entry in of_robot.iter_mut().filter(|entry| entry.key == "points") {
            if let Tree::Mapping(known) = &mut entry.value.value {
                known.retain(|point| points.iter().all(|own| own.key != point.key));
                known.append(&mut points);
            }
        }
        own.value = node;
    }
}
