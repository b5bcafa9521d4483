//! Tree of a YAML text: nodes with their locations.

use std::borrow::Cow;
use std::sync::Arc;

use symdiff::formula::SyntaxError;
use symdiff::formula::indices;

use super::scope::Scope;
use super::source::Span;

/// A node of the tree.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its bytes.
    pub span: Span,
    /// Kind of the node.
    pub value: Value,
}

/// Content of a node.
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
    /// The key's location.
    pub key_span: Span,
    /// The key's value.
    pub value: Node,
}

/// A piece of text.
#[derive(Clone, Debug)]
pub struct Scalar {
    /// The text, escapes resolved.
    pub text: String,
    /// Written without quotes.
    pub plain: bool,
    /// Offset of the text in the source, if it is there word for word.
    pub start: Option<usize>,
    /// Meanings of its names, if it is a copy of a piece of the file.
    pub scope: Option<Arc<Scope>>,
}

impl Scalar {
    /// A text without quotes, taken literally.
    pub fn plain(text: impl Into<String>, start: Option<usize>) -> Self {
        Self { text: text.into(), plain: true, start, scope: None }
    }

    /// Negates the number.
    pub fn negate(&mut self) {
        let scope = self.scope.clone().unwrap_or_default();
        self.scope = Some(Arc::new(scope.with_sign(!scope.is_negated())));
    }

    /// The text as the name of something.
    pub fn name(&self) -> Cow<'_, str> {
        match &self.scope {
            None => Cow::Borrowed(self.text.as_str()),
            Some(scope) => Cow::Owned(scope.reference(&self.text)),
        }
    }

    /// The text with the values of its indices.
    ///
    /// # Errors
    /// For errors in its braces.
    pub fn filled(&self) -> Result<String, SyntaxError> {
        indices::fill(&self.text, &|name| self.scope.as_ref()?.whole(name))
    }

    /// The location of a part of [`Self::name`]; that of the whole node if the name does not end as it is written.
    pub fn place_of_name(&self, node: &Span, part: Span) -> Span {
        let before = self
            .scope
            .as_ref()
            .map_or(0, |scope| self.name().len().saturating_sub(self.text.len()).min(scope.prefix().len()));
        match self.name().ends_with(&self.text) {
            true => self.place(node, part.start.saturating_sub(before)..part.end.saturating_sub(before)),
            false => node.clone(),
        }
    }

    /// Whether nothing was written, or `null`.
    pub fn is_null(&self) -> bool {
        self.plain && matches!(self.text.as_str(), "" | "~" | "null" | "Null" | "NULL")
    }

    /// The location of a part of the text; that of the whole node if the text is not in the source word for word.
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

    /// The same `by` bytes further on.
    #[must_use]
    pub fn moved(&self, by: usize) -> Self {
        self.copied(by, &|scalar| scalar.clone())
    }

    /// The same `by` bytes further on, with its scalars made anew by `scalar`.
    #[must_use]
    pub fn copied(&self, by: usize, scalar: &impl Fn(&Scalar) -> Scalar) -> Self {
        let moved = |span: &Span| span.start + by..span.end + by;
        let value = match &self.value {
            Value::Scalar(text) => {
                let copy = scalar(text);
                Value::Scalar(Scalar { start: text.start.map(|start| start + by), ..copy })
            }
            Value::Sequence(items) => Value::Sequence(items.iter().map(|item| item.copied(by, scalar)).collect()),
            Value::Mapping(entries) => {
                let copy = |entry: &Entry| Entry {
                    key: entry.key.clone(),
                    key_span: moved(&entry.key_span),
                    value: entry.value.copied(by, scalar),
                };
                Value::Mapping(entries.iter().map(copy).collect())
            }
        };
        Self { span: moved(&self.span), value }
    }

    /// The scalar, if it is one.
    pub fn scalar(&self) -> Option<&Scalar> {
        match &self.value {
            Value::Scalar(scalar) => Some(scalar),
            _ => None,
        }
    }

    /// Whether nothing was written, or `null`.
    pub fn is_null(&self) -> bool {
        self.scalar().is_some_and(Scalar::is_null)
    }

    /// Noun for messages.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Scalar(scalar) if scalar.is_null() => "nothing",
            Value::Scalar(_) => "a value",
            Value::Sequence(_) => "a list",
            Value::Mapping(_) => "a mapping",
        }
    }
}
