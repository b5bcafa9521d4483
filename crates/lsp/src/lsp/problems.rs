//! Diagnostics of models in the form of the protocol, and the fixes that they propose.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeDescription, Diagnostic, DiagnosticRelatedInformation,
    DiagnosticSeverity, Location, NumberOrString, Range, TextEdit, Uri, WorkspaceEdit,
};

use super::mechanism::MechanismError;
use super::text::Text;
use super::uri::uri_of;
use super::workspace::{Model, Workspace};
use crate::grammar::Span;
use crate::syntax::Code;
use crate::syntax::diagnostic::Severity;
use crate::syntax::suggest;

/// The name under which editors show diagnostics.
const SOURCE: &str = "mbint";

/// Diagnostics of a model by file, empty for files without any. `of_mechanism` is the error of the mechanism as a
/// whole.
pub fn of_model(
    workspace: &Workspace,
    model: &Model,
    of_mechanism: Option<&MechanismError>,
) -> BTreeMap<PathBuf, Vec<Diagnostic>> {
    let mut found: BTreeMap<PathBuf, Vec<Diagnostic>> = BTreeMap::new();
    let mut texts: BTreeMap<PathBuf, Text> = BTreeMap::new();
    let sources = &model.opened.reading.diagnostics.sources;
    for source in sources.all() {
        let path = PathBuf::from(&source.name);
        if !(model.is_made_up && path == model.path) {
            texts.insert(path.clone(), Text::new(source.text.clone()));
            found.insert(path, Vec::new());
        }
    }
    let place = |span: &Span| -> Option<(PathBuf, Range)> {
        let (source, span) = sources.locate(span)?;
        let path = PathBuf::from(&source.name);
        let range = texts.get(&path)?.range(&span);
        Some((path, range))
    };
    let mut said: HashSet<(PathBuf, u32, u32, String)> = HashSet::new();
    for own in model.opened.reading.diagnostics.iter() {
        let at = own.span.as_ref().map_or_else(|| Some((model.path.clone(), Range::default())), place);
        let Some((path, range)) = at else { continue };
        let related = own.secondary.iter().filter_map(|(span, label)| {
            let (path, range) = place(span)?;
            let location = Location { uri: address(workspace, &path)?, range };
            Some(DiagnosticRelatedInformation { location, message: label.clone() })
        });
        let related: Vec<_> = related.collect();
        let help = own.help.as_ref().map_or_else(String::new, |help| format!("\nhelp: {help}"));
        let diagnostic = Diagnostic {
            range,
            severity: Some(match own.severity {
                Severity::Error => DiagnosticSeverity::ERROR,
                Severity::Warning => DiagnosticSeverity::WARNING,
            }),
            code: Some(NumberOrString::String(own.code.id().to_owned())),
            code_description: page_of(own.code),
            source: Some(SOURCE.to_owned()),
            message: format!("{}{help}", own.message),
            related_information: (!related.is_empty()).then_some(related),
            ..Diagnostic::default()
        };
        // The same diagnostic in several instances counts once, whatever their names.
        let instance = own.span.as_ref().and_then(|span| sources.within(span)).map(|within| within.instance.as_str());
        let message = instance.map_or_else(|| own.message.clone(), |name| own.message.replace(name, ""));
        if said.insert((path.clone(), range.start.line, range.start.character, message)) {
            found.entry(path).or_default().push(diagnostic);
        }
    }
    if let (Some(error), Some(all)) = (of_mechanism, found.get_mut(&model.path)) {
        all.push(Diagnostic {
            range: Range::default(),
            severity: Some(DiagnosticSeverity::ERROR),
            code: error.code.map(|code| NumberOrString::String(code.id().to_owned())),
            code_description: error.code.and_then(page_of),
            source: Some(SOURCE.to_owned()),
            message: error.message.clone(),
            ..Diagnostic::default()
        });
    }
    found
}

/// Address of the page that explains a code.
fn page_of(code: Code) -> Option<CodeDescription> {
    Some(CodeDescription { href: code.href().parse().ok()? })
}

/// Changes that diagnostics at a range propose.
pub fn fixes(workspace: &Workspace, model: &Model, path: &Path, range: Range) -> Vec<CodeActionOrCommand> {
    let Some(document) = workspace.documents.get(path) else { return Vec::new() };
    let sources = &model.opened.reading.diagnostics.sources;
    let mut actions: Vec<CodeActionOrCommand> = Vec::new();
    for own in model.opened.reading.diagnostics.iter() {
        let Some((source, span)) = own.span.as_ref().and_then(|span| sources.locate(span)) else { continue };
        let at = document.text.range(&span);
        if Path::new(&source.name) != path || at.start > range.end || at.end < range.start {
            continue;
        }
        let Some(new) = own.help.as_deref().and_then(suggest::replacement) else { continue };
        let Some((span, new_text)) = replaced(&source.text, &span, new) else { continue };
        let (at, written) = (document.text.range(&span), &source.text[span]);
        let title = format!("Replace `{}` by `{new}`", suggest::clip(written));
        let edit = TextEdit { range: at, new_text };
        let known =
            |action: &CodeActionOrCommand| matches!(action, CodeActionOrCommand::CodeAction(own) if own.title == title);
        if actions.iter().any(known) {
            continue;
        }
        actions.push(CodeActionOrCommand::CodeAction(CodeAction {
            title,
            kind: Some(CodeActionKind::QUICKFIX),
            edit: Some(edit_of([(document.uri.clone(), vec![edit])])),
            is_preferred: Some(true),
            ..CodeAction::default()
        }));
    }
    actions
}

/// The bytes that a proposed text replaces, and the text. Quotes stay; a text to be quoted is searched for in the line.
fn replaced(text: &str, span: &Span, new: &str) -> Option<(Span, String)> {
    let written = text.get(span.clone())?;
    if let Some(unquoted) = new.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        let start = text[..span.start].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[span.start..].find('\n').map_or(text.len(), |newline| span.start + newline);
        let at = start + text[start..end].find(unquoted)?;
        return Some((at..at + unquoted.len(), new.to_owned()));
    }
    let quote = written.chars().next().filter(|first| matches!(first, '"' | '\''));
    let new_text = quote.map_or_else(|| new.to_owned(), |quote| format!("{quote}{new}{quote}"));
    (!written.is_empty()).then(|| (span.clone(), new_text))
}

/// A change of files.
#[allow(clippy::mutable_key_type, reason = "the protocol's type has addresses as keys, which nothing changes")]
pub fn edit_of(changes: impl IntoIterator<Item = (Uri, Vec<TextEdit>)>) -> WorkspaceEdit {
    WorkspaceEdit { changes: Some(changes.into_iter().collect()), ..WorkspaceEdit::default() }
}

/// The address of a file, as the editor writes it if the file is open.
pub fn address(workspace: &Workspace, path: &Path) -> Option<Uri> {
    workspace.documents.get(path).map(|own| own.uri.clone()).or_else(|| uri_of(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixes_apply_proposed_replacements() {
        let fixed = |text: &str, span: Span, help: &str| {
            let (span, new) = replaced(text, &span, suggest::replacement(help)?)?;
            let mut text = text.to_owned();
            text.replace_range(span, &new);
            Some(text)
        };
        assert_eq!(fixed("x: crnk.y", 3..7, "did you mean `crank`?").as_deref(), Some("x: crank.y"));
        assert_eq!(fixed("on: \"crnk\"", 4..10, "did you mean `crank`?").as_deref(), Some("on: \"crank\""));
        let help = "quote the interval: `\"[1, 2] m\"`";
        assert_eq!(fixed("a: [1, 2] m\nb: 1", 10..11, help).as_deref(), Some("a: \"[1, 2] m\"\nb: 1"));
        assert_eq!(fixed("x: 1", 0..1, "the keys are `a` and `b`"), None);
        assert_eq!(fixed("x: crnk", 3..7, "did you mean `a_name_that_was_cut…`?"), None);
    }
}
