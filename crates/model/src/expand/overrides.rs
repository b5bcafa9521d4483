//! `--set l1=0.16±2%`: parameters from the command line.

use crate::grammar::tolerance;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::yaml::{Node, Scalar, Value};

/// A parameter's new value, which replaces the file's value and tolerance; or a new tolerance of the file's value. Bare
/// numbers are in the unit that the file gives.
#[derive(Clone, Debug)]
pub struct Override {
    /// The parameter's name.
    pub name: String,
    /// The whole text, for messages.
    pub text: String,
    /// Value after the `=`.
    pub(crate) value: Node,
}

impl Override {
    /// `l1=0.16`, `l1=150 mm ± 1 mm`, `l1=0.16 +0.01 -0.02`, `l1=[0.1, 0.2] m`, `l1=±2%`.
    ///
    /// # Errors
    /// A text not of that form. Whether there is such a parameter, only a model can say.
    pub fn parse(text: &str) -> Result<Self, Diagnostics> {
        Self::at(text, 0).map_err(|diagnostic| {
            let mut diagnostics = Diagnostics::new("--set", text);
            diagnostics.push(*diagnostic);
            diagnostics
        })
    }

    /// Reads the text as one that begins at an offset of the sources.
    pub(crate) fn at(text: &str, offset: usize) -> Result<Self, Box<Diagnostic>> {
        let error = |span: Span, message: &str| {
            let diagnostic = Diagnostic::error(Code::BadOverride, offset + span.start..offset + span.end, message);
            let help = "write `name=value`, `name=value ± tolerance`, or `name=[lower, upper]`";
            Err(Box::new(diagnostic.help(help.to_owned())))
        };
        let Some(equals) = text.find('=') else {
            return error(0..text.len(), "a parameter is set with `=`");
        };
        let name = text[..equals].trim();
        if name.is_empty() {
            return error(0..equals + 1, "the parameter's name is missing");
        }
        let written = text[equals + 1..].trim();
        if written.is_empty() {
            return error(0..text.len(), "the value is missing");
        }
        let start = offset + text.len() - text[equals + 1..].trim_start().len();
        let scalar = Scalar::plain(written, Some(start));
        let value = Node { span: start..start + written.len(), value: Value::Scalar(scalar) };
        tolerance::read(&value)?;
        Ok(Self { name: name.to_owned(), text: text.to_owned(), value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_without_a_value_is_reported_at_its_beginning() {
        let records = Override::parse("l1").unwrap_err().records();
        assert_eq!((records[0].message.as_str(), records[0].file.as_str()), ("a parameter is set with `=`", "--set"));
        assert_eq!((records[0].line, records[0].column), (Some(1), Some(1)));
    }
}
