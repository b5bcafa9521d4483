//! Sections of a model's tree.

use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Value};

/// The entries of a section, which is created if it is absent; `None` if it is no mapping.
pub fn entries_of<'s>(sections: &'s mut Vec<Entry>, key: &str, at: &Span) -> Option<&'s mut Vec<Entry>> {
    let found = sections.iter().position(|entry| entry.key == key && !entry.value.is_null());
    let index = found.unwrap_or_else(|| {
        sections.retain(|entry| entry.key != key);
        let value = Node { span: at.clone(), value: Value::Mapping(Vec::new()) };
        sections.push(Entry { key: key.to_owned(), key_span: at.clone(), value });
        sections.len() - 1
    });
    match &mut sections[index].value.value {
        Value::Mapping(entries) => Some(entries),
        _ => None,
    }
}
