//! `--with FILE`: parameters that a file lays over a model, as `mbint allocate` writes it.

use std::path::Path;

use crate::expand::overrides::Override;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::text_file::read_text;
use crate::syntax::tuning::TUNING;
use crate::syntax::yaml::{self, Entry, Node, Value};

/// Keys of the file, and of a parameter in it.
const KEYS: [&str; 2] = ["parameters", "description"];
const PARTS: [&str; 2] = ["value", "tolerance"];

/// Reads the parameters of a file, to be set in a model.
///
/// # Errors
/// Everything that is wrong with the file.
pub fn read_overlay(path: &Path) -> Result<Vec<Override>, Diagnostics> {
    let name = super::load::shown(path);
    let text = read_text(path, TUNING.file_bytes).map_err(|error| {
        let mut diagnostics = Diagnostics::new(name.clone(), "");
        diagnostics.push(*error);
        diagnostics
    })?;
    let mut diagnostics = Diagnostics::new(name, text.clone());
    let mut found = Vec::new();
    if let Some(root) = yaml::parse(&text, &mut diagnostics) {
        for entry in entries(&root, &mut diagnostics) {
            match entry.key.as_str() {
                "parameters" => {
                    let parameters = entries(&entry.value, &mut diagnostics);
                    found.extend(parameters.iter().filter_map(|entry| parameter(entry, &mut diagnostics)));
                }
                "description" => (),
                other => {
                    let help = suggest::help(other, "keys", KEYS);
                    let message = format!("`{}` cannot stand in an overlay of a model", clip(other));
                    error(&mut diagnostics, entry.key_span.clone(), message, help);
                }
            }
        }
    }
    if diagnostics.has_errors() { Err(diagnostics) } else { Ok(found) }
}

fn error(diagnostics: &mut Diagnostics, span: Span, message: String, help: impl Into<Option<String>>) {
    diagnostics.push(Diagnostic::error(Code::BadOverride, span, message).help(help));
}

fn entries<'n>(node: &'n Node, diagnostics: &mut Diagnostics) -> &'n [Entry] {
    match &node.value {
        Value::Mapping(entries) => entries,
        _ => {
            let help = "e.g. `parameters: { a: 30 mm ± 0.02 mm }`".to_owned();
            error(diagnostics, node.span.clone(), "a mapping belongs here".to_owned(), help);
            &[]
        }
    }
}

/// A parameter in one piece, or its value and tolerance.
fn parameter(entry: &Entry, diagnostics: &mut Diagnostics) -> Option<Override> {
    let written = match &entry.value.value {
        Value::Scalar(scalar) => scalar.text.clone(),
        Value::Mapping(fields) => {
            let wrong =
                fields.iter().find(|field| !PARTS.contains(&field.key.as_str()) || field.value.scalar().is_none());
            if let Some(field) = wrong {
                let message = format!("`{}` cannot be laid over a parameter", clip(&field.key));
                let help = "write it in one piece, as `30 mm ± 0.02 mm` or `30 mm +0.02 -0.01`".to_owned();
                error(diagnostics, field.key_span.clone(), message, help);
                return None;
            }
            let text = |key: &str| {
                let field = fields.iter().find(|field| field.key == key);
                field.and_then(|field| field.value.scalar()).map(|scalar| scalar.text.trim())
            };
            let tolerance = text("tolerance").map_or_else(String::new, |text| format!("± {text}"));
            format!("{} {tolerance}", text("value").unwrap_or_default()).trim().to_owned()
        }
        Value::Sequence(_) => {
            let help = "write it in one piece, as `30 mm ± 0.02 mm`".to_owned();
            error(diagnostics, entry.value.span.clone(), "a parameter is no list".to_owned(), help);
            return None;
        }
    };
    match Override::parse(&format!("{}={written}", entry.key)) {
        Ok(found) => Some(found),
        Err(wrong) => {
            let message = wrong.records().into_iter().map(|record| record.message).collect::<Vec<_>>().join("; ");
            error(diagnostics, entry.value.span.clone(), message, None);
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<String>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("with.yaml");
        std::fs::write(&path, text).unwrap();
        let texts = |found: Vec<Override>| found.into_iter().map(|own| own.text).collect();
        read_overlay(&path).map(texts).map_err(|wrong| wrong.records()[0].message.clone())
    }

    #[test]
    fn parameters_in_one_piece_or_by_keys() {
        let text =
            "parameters:\n  a: 30 mm ± 0.02 mm\n  b: ± 0.1 mm\n  c: { value: 2, tolerance: 1% }\n  d: 3 mm +0.1 -0.2\n";
        assert_eq!(read(text).unwrap(), ["a=30 mm ± 0.02 mm", "b=± 0.1 mm", "c=2 ± 1%", "d=3 mm +0.1 -0.2"]);
        for (text, message) in [
            ("bodies: {}", "`bodies` cannot stand in an overlay of a model"),
            ("parameters: 3", "a mapping belongs here"),
            ("parameters: { a: [1, 2] }", "a parameter is no list"),
            ("parameters: { a: { cost: fixed } }", "`cost` cannot be laid over a parameter"),
            ("parameters: { a: 3 ± }", "a number belongs behind the `±`"),
        ] {
            assert_eq!(read(text).unwrap_err(), message);
        }
    }
}
