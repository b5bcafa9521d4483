//! Formulas that YAML cuts at their commas: between braces, `torque: max(a, b)` is `torque: max(a`, and a key `b)`.
//! The pieces are joined again, so that the message is about the comma, and not about its consequences.

use super::codes::Code;
use super::diagnostic::{Diagnostic, Diagnostics};
use super::source::Span;
use super::suggest::clip;
use super::tree::{Entry, Node, Scalar, Value};

/// Joins the values of a mapping in braces that a comma has cut.
pub(super) fn join_values(text: &str, entries: Vec<Entry>, diagnostics: &mut Diagnostics) -> Vec<Entry> {
    let mut joined: Vec<Entry> = Vec::with_capacity(entries.len());
    let mut entries = entries.into_iter().peekable();
    while let Some(entry) = entries.next() {
        match joined.last_mut().filter(|_| entry.value.is_null()) {
            Some(last) if is_open(&last.value) => {
                last.value = together(text, &last.value, &entry.key_span, diagnostics);
            }
            Some(last) if is_decimal(&last.value, &entry.key) => {
                last.value = with_point(&last.value, &entry, diagnostics);
            }
            Some(last) if is_text(last, &entry.key) => {
                let rest = std::iter::from_fn(|| entries.next_if(|next| next.value.is_null())).last();
                let span = last.value.span.start..rest.unwrap_or(entry).key_span.end;
                let written = text.get(span.clone()).unwrap_or("");
                let help = format!("quote the text: `\"{}\"`", clip(written));
                let message = "an unquoted comma ends the text between braces";
                diagnostics.push(Diagnostic::error(Code::UnquotedComma, span.clone(), message).help(help));
                last.value = Node { span, value: Value::Scalar(Scalar::plain(written, None)) };
            }
            _ => joined.push(entry),
        }
    }
    joined
}

/// Joins the items of a list in brackets that a comma has cut.
pub(super) fn join_items(text: &str, items: Vec<Node>, diagnostics: &mut Diagnostics) -> Vec<Node> {
    let mut joined: Vec<Node> = Vec::with_capacity(items.len());
    for item in items {
        match joined.last_mut().filter(|last| is_open(last) && item.scalar().is_some_and(|scalar| scalar.plain)) {
            Some(last) => *last = together(text, last, &item.span, diagnostics),
            None => joined.push(item),
        }
    }
    joined
}

/// Whether a parenthesis of an unquoted text is not closed.
fn is_open(node: &Node) -> bool {
    let depth = |text: &str| text.matches('(').count() > text.matches(')').count();
    node.scalar().is_some_and(|scalar| scalar.plain && depth(&scalar.text))
}

/// Whether a whole number and a key are the two sides of a decimal comma: `0,5`, perhaps with a unit.
fn is_decimal(first: &Node, second: &str) -> bool {
    let is_whole = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let whole = first.scalar().filter(|scalar| scalar.plain).map(|scalar| scalar.text.trim_start_matches(['+', '-']));
    whole.is_some_and(is_whole) && second.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether a key continues a text that a comma has cut: no key has a space.
fn is_text(before: &Entry, key: &str) -> bool {
    let is_plain = before.value.scalar().is_some_and(|scalar| scalar.plain && !scalar.text.is_empty());
    is_plain && (before.key == "description" || key.contains(' '))
}

/// A number whose decimal comma is reported, with a point.
fn with_point(first: &Node, second: &Entry, diagnostics: &mut Diagnostics) -> Node {
    let span = first.span.start..second.key_span.end;
    let number = format!("{}.{}", first.scalar().map_or("", |scalar| &scalar.text), second.key);
    let help = format!("decimals stand behind a point: `{}`", clip(&number));
    diagnostics.push(
        Diagnostic::error(Code::UnquotedComma, span.clone(), "a comma ends the number between braces").help(help),
    );
    Node { span, value: Value::Scalar(Scalar::plain(number, None)) }
}

/// Joins a text and the piece after its comma; reports the comma if the last parenthesis is closed.
fn together(text: &str, first: &Node, second: &Span, diagnostics: &mut Diagnostics) -> Node {
    let span = first.span.start..second.end.max(first.span.end);
    let written = text.get(span.clone()).unwrap_or("").trim_end();
    let span = span.start..span.start + written.len();
    let scalar = Scalar::plain(written, Some(span.start));
    let node = Node { span: span.clone(), value: Value::Scalar(scalar) };
    if !is_open(&node) {
        let help = format!("quote the formula: `\"{}\"`", clip(written));
        diagnostics.push(
            Diagnostic::error(Code::UnquotedComma, span, "an unquoted comma ends the value between braces or brackets")
                .help(help),
        );
    }
    node
}
