//! `--set l1=0.16±2%`: parameters from the command line.

use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::yaml::{Node, Scalar, Value};

/// A parameter's new value; it replaces the file's value and tolerance. Bare numbers are in the unit that the file
/// gives.
#[derive(Clone, Debug)]
pub struct Override {
    /// The parameter's name.
    pub name: String,
    /// The whole text, for messages.
    pub text: String,
    pub(super) value: Option<Node>,
    pub(super) tolerance: Option<Node>,
    pub(super) interval: Option<Node>,
}

impl Override {
    /// `l1=0.16`, `l1=150 mm±1 mm`, `l1=0.16+-2%`, `l1=[0.1, 0.2]`.
    ///
    /// # Errors
    /// What is not of that form. Whether there is such a parameter, only a model can say.
    pub fn parse(text: &str) -> Result<Self, Diagnostics> {
        Self::at(text, 0).map_err(|diagnostic| {
            let mut diagnostics = Diagnostics::new("--set", text);
            diagnostics.push(*diagnostic);
            diagnostics
        })
    }

    /// Reads the text as one that begins at an offset of the sources.
    pub(super) fn at(text: &str, offset: usize) -> Result<Self, Box<Diagnostic>> {
        let error = |span: Span, message: &str| {
            let diagnostic = Diagnostic::error(offset + span.start..offset + span.end, message);
            let help = "write `name=value`, `name=value±tolerance`, or `name=[lower, upper]`";
            Err(Box::new(diagnostic.help(help.to_owned())))
        };
        let Some(equals) = text.find('=') else {
            return error(0..text.len(), "a parameter is set with `=`");
        };
        let name = text[..equals].trim();
        if name.is_empty() {
            return error(0..equals + 1, "the parameter's name is missing");
        }
        let node = |span: Span| {
            let part = &text[span.clone()];
            let start = span.start + part.len() - part.trim_start().len();
            let part = part.trim();
            let scalar = Scalar { text: part.to_owned(), plain: true, start: Some(offset + start) };
            Node { span: offset + start..offset + start + part.len(), value: Value::Scalar(scalar) }
        };
        let mut result =
            Self { name: name.to_owned(), text: text.to_owned(), value: None, tolerance: None, interval: None };
        let value = node(equals + 1..text.len());
        let start = value.span.start - offset;
        let Some(written) = value.scalar().map(|scalar| scalar.text.as_str()).filter(|written| !written.is_empty())
        else {
            return error(0..text.len(), "the value is missing");
        };
        if let Some(inner) = written.strip_prefix('[') {
            let Some(inner) = inner.strip_suffix(']') else {
                return error(start..start + written.len(), "the interval's `]` is missing");
            };
            let parts: Vec<&str> = inner.split(',').collect();
            let [first, second] = parts.as_slice() else {
                return error(start..start + written.len(), "an interval has two ends");
            };
            let middle = start + 1 + first.len();
            let ends = vec![node(start + 1..middle), node(middle + 1..middle + 1 + second.len())];
            result.interval = Some(Node { span: value.span.clone(), value: Value::Sequence(ends) });
        } else if let Some((at, sign)) =
            written.find('±').map(|at| (at, "±")).or(written.find("+-").map(|at| (at, "+-")))
        {
            let behind = start + at + sign.len();
            if written[..at].trim().is_empty() || text[behind..].trim().is_empty() {
                return error(start..start + written.len(), "a number belongs on either side of the `±`");
            }
            result.value = Some(node(start..start + at));
            result.tolerance = Some(node(behind..text.len()));
        } else {
            result.value = Some(value);
        }
        Ok(result)
    }
}
