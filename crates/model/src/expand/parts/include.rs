//! `include:`, files of assemblies.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Writer;
use crate::expand::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::tuning::TUNING as SYNTAX;
use crate::syntax::yaml::{self, Entry, Node, Value};

/// Files that are read, with their names from the model's folder.
#[derive(Default)]
struct Included {
    /// Those that include the next.
    open: Vec<PathBuf>,
    /// All.
    read: Vec<PathBuf>,
}

/// Reads the files that a model includes, and notes their assemblies.
pub(super) fn read(writer: &mut Writer, entries: &[Entry]) {
    let Some(entry) = entries.iter().find(|entry| entry.key == "include") else { return };
    // The model itself includes no assemblies of its own again.
    let model = writer.report.diagnostics.sources.first();
    let open = model.and_then(|model| Path::new(&model.name).file_name()).map(PathBuf::from).into_iter().collect();
    names(writer, &entry.value, Path::new(""), &mut Included { open, read: Vec::new() });
}

/// The files of an `include`, whose names are from a folder, which is seen from the model's.
fn names(writer: &mut Writer, node: &Node, folder: &Path, included: &mut Included) {
    let items = match &node.value {
        Value::Sequence(items) => items.as_slice(),
        _ => std::slice::from_ref(node),
    };
    for item in items {
        let Some(scalar) = writer.report.scalar(item, "the name of a file, or a list of them,") else { continue };
        let (name, span) = (scalar.text.clone(), item.span.clone());
        match writer.report.files.find(folder, &name) {
            Ok(path) => file(writer, path, &span, included),
            Err(error) => writer.report.error(error.code, span, error.message, error.help),
        }
    }
}

fn file(writer: &mut Writer, path: PathBuf, span: &Span, included: &mut Included) {
    if let Some(first) = included.open.iter().position(|open| *open == path) {
        let circle = included.open[first..].iter().chain([&path]).map(|path| clip(&path.display().to_string()));
        let message = format!("files include each other in a circle: {}", circle.collect::<Vec<_>>().join(" → "));
        writer.report.error(Code::Circle, span.clone(), message, None);
        return;
    }
    if included.read.contains(&path) {
        return;
    }
    if included.read.len() == TUNING.files {
        writer.report.error(
            Code::TooLarge,
            span.clone(),
            format!("the model includes more than {files} files", files = TUNING.files),
            None,
        );
        return;
    }
    included.read.push(path.clone());
    let full = writer.report.files.full(&path);
    let text = match writer.report.files.read(&full, SYNTAX.file_bytes) {
        Ok(text) => text,
        Err(error) => {
            let help = error.help.clone().or_else(|| Some("paths are relative to the model's folder".to_owned()));
            writer.report.diagnostics.push(Diagnostic::error(error.code, span.clone(), error.message).help(help));
            return;
        }
    };
    let start = writer.report.diagnostics.sources.add(full.display().to_string(), text.clone());
    let parsed = writer.report.diagnostics.read_more(start, &text, |diagnostics| yaml::parse(&text, diagnostics));
    let Some(root) = parsed.map(|root| root.moved(start)) else { return };
    let Some(fields) = writer.report.fields::<keys::Part>(&root, root.span.start..root.span.start) else { return };
    included.open.push(path.clone());
    if let Some(node) = fields.get("include") {
        names(writer, node, path.parent().unwrap_or(Path::new("")), included);
    }
    included.open.pop();
    writer.define(&root);
}

impl Writer<'_, '_> {
    /// Notes the assemblies of a file.
    pub(super) fn define(&mut self, root: &Node) {
        let Some(node) = root.get("assemblies") else { return };
        for entry in self.report.entries(node, "assemblies") {
            if !self.report.is_name(&entry.key, &entry.key_span, "an assembly") {
                continue;
            }
            match self.definitions.get(&entry.key).map(|known| known.key_span.clone()) {
                Some(first) => self.twice(&entry.key, &entry.key_span, &first),
                None => {
                    self.report.defines(NameKind::Assembly, &entry.key, entry);
                    self.definitions.insert(entry.key.clone(), Arc::new(entry.clone()));
                }
            }
        }
    }
}
