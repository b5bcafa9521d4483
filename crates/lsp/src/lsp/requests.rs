//! Requests of an editor, each with its answer.

use std::path::{Path, PathBuf};

use lsp_server::{ErrorCode, ResponseError};
use lsp_types::request::{self as protocol, Request};
use lsp_types::{
    CodeActionParams, CompletionParams, CompletionResponse, DocumentFormattingParams, DocumentHighlight,
    DocumentHighlightKind, DocumentHighlightParams, DocumentSymbolParams, DocumentSymbolResponse, FoldingRangeParams,
    GotoDefinitionParams, GotoDefinitionResponse, Hover, HoverContents, HoverParams, MarkupContent, MarkupKind,
    PrepareRenameResponse, Range, ReferenceParams, RenameParams, TextDocumentPositionParams, TextEdit, Uri,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::completion::complete;
use super::format::formatted;
use super::hover::hover;
use super::navigation::{definitions, name_at, references, rename};
use super::outline::{folding, outline};
use super::problems::fixes;
use super::schema::Schema;
use super::uri::path_of;
use super::workspace::{Document, Workspace};

/// Data from which answers are made.
pub struct Answers<'a> {
    /// Documents and their models.
    pub workspace: &'a Workspace,
    /// The language.
    pub schema: &'a Schema,
    /// Whether the editor fills in fields of inserted texts.
    pub snippets: bool,
}

type Answer = Result<Value, ResponseError>;

impl Answers<'_> {
    /// The answer to a request.
    ///
    /// # Errors
    /// For an unknown method, parameters of another form, or a name that cannot be given.
    pub fn answer(&self, method: &str, params: Value) -> Answer {
        match method {
            protocol::Completion::METHOD => of(params, |params| self.completion(params)),
            protocol::HoverRequest::METHOD => of(params, |params| self.hover(params)),
            protocol::GotoDefinition::METHOD => of(params, |params| self.definition(params)),
            protocol::References::METHOD => of(params, |params| self.references(params)),
            protocol::DocumentHighlightRequest::METHOD => of(params, |params| self.highlight(params)),
            protocol::PrepareRenameRequest::METHOD => of(params, |params| self.prepare_rename(params)),
            protocol::Rename::METHOD => self.rename(read(params)?),
            protocol::DocumentSymbolRequest::METHOD => of(params, |params| self.outline(params)),
            protocol::FoldingRangeRequest::METHOD => of(params, |params| self.folding(params)),
            protocol::Formatting::METHOD => of(params, |params| self.formatting(params)),
            protocol::CodeActionRequest::METHOD => of(params, |params| self.actions(params)),
            _ => Err(error(ErrorCode::MethodNotFound, format!("`{method}` is not known here"))),
        }
    }

    fn document(&self, uri: &Uri) -> Option<(PathBuf, &Document)> {
        let path = path_of_document(uri);
        let document = self.workspace.documents.get(&path)?;
        Some((path, document))
    }

    /// The document of a position, and the byte in it.
    fn place(&self, at: &TextDocumentPositionParams) -> Option<(PathBuf, &Document, usize)> {
        let (path, document) = self.document(&at.text_document.uri)?;
        let offset = document.text.offset(at.position);
        Some((path, document, offset))
    }

    fn completion(&self, params: CompletionParams) -> Option<CompletionResponse> {
        let (path, document, offset) = self.place(&params.text_document_position)?;
        let model = self.workspace.model_of(&path);
        let list = complete(self.schema, model, &path, &document.text, offset, self.snippets);
        Some(CompletionResponse::List(list))
    }

    fn hover(&self, params: HoverParams) -> Option<Hover> {
        let (path, document, offset) = self.place(&params.text_document_position_params)?;
        let found = hover(self.schema, self.workspace.model_of(&path), &path, &document.text, offset)?;
        let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: found.text });
        Some(Hover { contents, range: Some(document.text.range(&found.span)) })
    }

    fn definition(&self, params: GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
        let (path, _, offset) = self.place(&params.text_document_position_params)?;
        let model = self.workspace.model_of(&path)?;
        Some(GotoDefinitionResponse::Array(definitions(self.workspace, model, &path, offset)))
    }

    fn references(&self, params: ReferenceParams) -> Option<Vec<lsp_types::Location>> {
        let (path, _, offset) = self.place(&params.text_document_position)?;
        let model = self.workspace.model_of(&path)?;
        Some(references(self.workspace, model, &path, offset, params.context.include_declaration))
    }

    fn highlight(&self, params: DocumentHighlightParams) -> Option<Vec<DocumentHighlight>> {
        let (path, document, offset) = self.place(&params.text_document_position_params)?;
        let names = &self.workspace.model_of(&path)?.names;
        let symbol = names.at(&path, offset)?.symbol;
        let here = names.of_symbol(symbol).filter(|own| own.at.file.as_path() == path);
        let kind =
            |is_definition| if is_definition { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        Some(
            here.map(|own| DocumentHighlight {
                range: document.text.range(&own.at.span),
                kind: Some(kind(own.is_definition)),
            })
            .collect(),
        )
    }

    fn prepare_rename(&self, params: TextDocumentPositionParams) -> Option<PrepareRenameResponse> {
        let (path, document, offset) = self.place(&params)?;
        let (name, range) = name_at(self.workspace.model_of(&path)?, &path, &document.text, offset)?;
        Some(PrepareRenameResponse::RangeWithPlaceholder { range, placeholder: name.to_owned() })
    }

    fn rename(&self, params: RenameParams) -> Answer {
        let Some((path, _, offset)) = self.place(&params.text_document_position) else { return Ok(Value::Null) };
        let Some(model) = self.workspace.model_of(&path) else { return Ok(Value::Null) };
        let renamed = rename(self.workspace, model, &path, offset, &params.new_name);
        renamed.map(written).map_err(|own| error(ErrorCode::RequestFailed, own.to_string()))
    }

    fn outline(&self, params: DocumentSymbolParams) -> Option<DocumentSymbolResponse> {
        let (_, document) = self.document(&params.text_document.uri)?;
        Some(DocumentSymbolResponse::Nested(outline(&document.text)))
    }

    fn folding(&self, params: FoldingRangeParams) -> Option<Vec<lsp_types::FoldingRange>> {
        let (_, document) = self.document(&params.text_document.uri)?;
        Some(folding(&document.text))
    }

    fn formatting(&self, params: DocumentFormattingParams) -> Option<Vec<TextEdit>> {
        let (_, document) = self.document(&params.text_document.uri)?;
        let new_text = formatted(document.text.as_str())?;
        if new_text == document.text.as_str() {
            return Some(Vec::new());
        }
        let range = document.text.range(&(0..document.text.as_str().len()));
        Some(vec![TextEdit { range, new_text }])
    }

    fn actions(&self, params: CodeActionParams) -> Option<Vec<lsp_types::CodeActionOrCommand>> {
        let (path, _) = self.document(&params.text_document.uri)?;
        let range: Range = params.range;
        Some(fixes(self.workspace, self.workspace.model_of(&path)?, &path, range))
    }
}

/// The path of a document; for one that is no file, a path in the working directory that does not exist.
pub fn path_of_document(uri: &Uri) -> PathBuf {
    path_of(uri).unwrap_or_else(|| {
        let name: String = uri.as_str().chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        std::env::current_dir().unwrap_or_default().join(Path::new(&name))
    })
}

fn of<P: DeserializeOwned, R: Serialize>(params: Value, answer: impl FnOnce(P) -> Option<R>) -> Answer {
    Ok(answer(read(params)?).map_or(Value::Null, written))
}

fn read<P: DeserializeOwned>(params: Value) -> Result<P, ResponseError> {
    serde_json::from_value(params).map_err(|own| error(ErrorCode::InvalidParams, own.to_string()))
}

/// Types of the protocol are plain data: writing them cannot fail.
fn written(answer: impl Serialize) -> Value {
    serde_json::to_value(answer).unwrap_or_default()
}

/// An error in the form of the protocol.
pub fn error(code: ErrorCode, message: String) -> ResponseError {
    ResponseError { code: code as i32, message, data: None }
}
