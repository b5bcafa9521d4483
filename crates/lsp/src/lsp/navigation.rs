//! Definitions, references, and new names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_types::{Location, Range, TextEdit, WorkspaceEdit};

use super::names::Occurrence;
use super::problems::{address, edit_of};
use super::text::Text;
use super::workspace::{Model, Workspace};
use crate::model::read_open;
use crate::syntax::diagnostic::{Diagnostics, Severity};
use crate::syntax::suggest::clip;

/// Why a name cannot be changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenameError {
    /// There is no name at the cursor.
    #[error("there is no name of the model here")]
    NoName,
    /// The new name is not a valid name.
    #[error("`{0}` cannot be a name: letters, digits and `_`, a letter first")]
    NotAName(String),
    /// The name is made with an index, or is in an escaped text.
    #[error("`{name}` is written as `{written}` in line {line}: change it by hand")]
    WrittenOtherwise {
        /// The name.
        name: String,
        /// The text at its location.
        written: String,
        /// From 1.
        line: usize,
    },
    /// The model would have an error.
    #[error("with the name `{new}`, the model would have an error: {message}")]
    Breaks {
        /// The new name.
        new: String,
        /// The first error.
        message: String,
    },
}

/// Definitions of the symbol at a byte.
pub fn definitions(workspace: &Workspace, model: &Model, path: &Path, offset: usize) -> Vec<Location> {
    locations(workspace, model, path, offset, |own| own.is_definition)
}

/// Uses of the symbol at a byte, and its definitions if `with_definition`.
pub fn references(
    workspace: &Workspace,
    model: &Model,
    path: &Path,
    offset: usize,
    with_definition: bool,
) -> Vec<Location> {
    locations(workspace, model, path, offset, |own| with_definition || !own.is_definition)
}

fn locations(
    workspace: &Workspace,
    model: &Model,
    path: &Path,
    offset: usize,
    is_wanted: impl Fn(&Occurrence) -> bool,
) -> Vec<Location> {
    let Some(symbol) = model.names.at(path, offset).map(|own| own.symbol) else { return Vec::new() };
    let mut texts: BTreeMap<PathBuf, Text> = BTreeMap::new();
    let mut found = Vec::new();
    for own in model.names.of_symbol(symbol).filter(|own| is_wanted(own)) {
        let file = own.at.file.as_path();
        if !texts.contains_key(file) {
            let Some(text) = workspace.text_of(model, file) else { continue };
            texts.insert(file.to_owned(), text);
        }
        let Some(uri) = address(workspace, file) else { continue };
        found.push(Location { uri, range: texts[file].range(&own.at.span) });
    }
    found
}

/// The name at a byte, and its range.
pub fn name_at<'m>(model: &'m Model, path: &Path, text: &Text, offset: usize) -> Option<(&'m str, Range)> {
    let found = model.names.at(path, offset)?;
    let name = model.names.symbols[found.symbol].name.rsplit('.').next()?;
    Some((name, text.range(&found.at.span)))
}

/// Changes that rename the symbol at a byte, in all files of the model.
///
/// # Errors
/// If there is no name, it is written in another way, the new name is not valid, or a model would get errors with it.
pub fn rename(
    workspace: &Workspace,
    model: &Model,
    path: &Path,
    offset: usize,
    new: &str,
) -> Result<WorkspaceEdit, RenameError> {
    let symbol = model.names.at(path, offset).ok_or(RenameError::NoName)?.symbol;
    let mut letters = new.chars();
    let is_name = letters.next().is_some_and(|c| c.is_alphabetic() || c == '_')
        && letters.all(|c| c.is_alphanumeric() || c == '_');
    if !is_name {
        return Err(RenameError::NotAName(clip(new)));
    }
    let full = model.names.symbols[symbol].name.as_str();
    let old = full.rsplit('.').next().unwrap_or(full);
    let mut edits: BTreeMap<PathBuf, (Text, Vec<std::ops::Range<usize>>)> = BTreeMap::new();
    for own in model.names.of_symbol(symbol) {
        let file = own.at.file.as_path();
        if !edits.contains_key(file) {
            let text = workspace.text_of(model, file).ok_or(RenameError::NoName)?;
            edits.insert(file.to_owned(), (text, Vec::new()));
        }
        let (text, spans) = edits.get_mut(file).ok_or(RenameError::NoName)?;
        let mut span = own.at.span.clone();
        let written = text.as_str().get(span.clone()).unwrap_or_default();
        // A quoted key keeps its quotes.
        let inner = written.trim_matches(['"', '\'']);
        if inner.len() + 2 == written.len() {
            span = span.start + 1..span.end - 1;
        }
        if inner != old {
            let (name, line) = (old.to_owned(), text.line_of(span.start) + 1);
            return Err(RenameError::WrittenOtherwise { name, written: clip(written), line });
        }
        spans.push(span);
    }
    let mut changed = BTreeMap::new();
    for (file, (text, spans)) in &mut edits {
        spans.sort_by_key(|span| span.start);
        let mut new_text = text.as_str().to_owned();
        spans.iter().rev().for_each(|span| new_text.replace_range(span.clone(), new));
        changed.insert(file.clone(), new_text);
    }
    still_reads(workspace, model, &changed, new)?;
    let changes = edits.into_iter().filter_map(|(file, (text, spans))| {
        let edit = |span: &std::ops::Range<usize>| TextEdit { range: text.range(span), new_text: new.to_owned() };
        Some((address(workspace, &file)?, spans.iter().map(edit).collect()))
    });
    Ok(edit_of(changes.collect::<Vec<_>>()))
}

/// Checks that the changes give no model of the workspace more errors than it has.
fn still_reads(
    workspace: &Workspace,
    model: &Model,
    changed: &BTreeMap<PathBuf, String>,
    new: &str,
) -> Result<(), RenameError> {
    let messages = |found: &Diagnostics| -> Vec<String> {
        found.iter().filter(|own| own.severity == Severity::Error).map(|own| own.message.clone()).collect()
    };
    let others = workspace.models().filter(|own| own.path != model.path && changed.keys().any(|file| own.has(file)));
    for own in others.chain([model]) {
        let mut open = workspace.texts_with(changed);
        let first = own.opened.reading.diagnostics.sources.first();
        if let (Some(first), None) = (first, open.get(&own.path)) {
            open = open.with(own.path.clone(), first.text.clone());
        }
        let read = read_open(&own.path, &open, workspace.root.as_deref());
        let before = messages(&own.opened.reading.diagnostics);
        let after = messages(&read.reading.diagnostics);
        if after.len() > before.len() {
            let message = after.into_iter().find(|message| !before.contains(message)).unwrap_or_default();
            return Err(RenameError::Breaks { new: new.to_owned(), message });
        }
    }
    Ok(())
}
