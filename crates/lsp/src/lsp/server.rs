//! The server's loop: handles an editor's messages one after the other.
//!
//! Texts are read anew when the editor pauses or asks; so a burst of keystrokes costs one reading.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;

use lsp_server::{Connection, ErrorCode, Message, Notification, ProtocolError, Request, Response};
use lsp_types::notification::{self as protocol, Notification as _};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionProviderCapability, CompletionOptions, Diagnostic,
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams, HoverProviderCapability,
    InitializeParams, OneOf, PublishDiagnosticsParams, RenameOptions, ServerCapabilities, TextDocumentSyncCapability,
    TextDocumentSyncKind,
};
use serde::de::DeserializeOwned;

use super::mechanism::{self, MechanismError, Question};
use super::problems::{address, of_model};
use super::requests::{Answers, error, path_of_document};
use super::schema::Schema;
use super::text::Text;
use super::uri::path_of;
use super::workspace::{Document, Workspace};
use crate::study;

/// Why a server ended.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// The editor does not speak the protocol.
    #[error("the editor does not speak the protocol: {0}")]
    Protocol(#[from] ProtocolError),
    /// Messages could not be written or read.
    #[error("messages cannot be exchanged: {0}")]
    Io(#[from] io::Error),
    /// The editor's capabilities cannot be read.
    #[error("the editor's capabilities cannot be read: {0}")]
    Capabilities(#[from] serde_json::Error),
}

/// An event that the loop waits for.
enum Event {
    Message(Message),
    Mechanism(mechanism::Answer),
    /// The editor has closed its end.
    End,
}

/// Serves an editor on standard input and output until it announces its exit; `root` is a folder whose files models may
/// name, in addition to those of their own folders.
///
/// # Errors
/// If the protocol is not followed.
pub fn serve(root: Option<PathBuf>) -> Result<(), ServerError> {
    let (connection, threads) = Connection::stdio();
    if attend(&connection, root)? {
        drop(connection);
        threads.join()?;
    }
    Ok(())
}

/// Serves the editor at the other end of a connection, as [`serve`] does. Returns whether it announced its exit; if
/// not, it has closed its end.
///
/// # Errors
/// If the protocol is not followed.
pub fn attend(connection: &Connection, root: Option<PathBuf>) -> Result<bool, ServerError> {
    let params = connection.initialize(serde_json::to_value(capabilities())?)?;
    let params: InitializeParams = serde_json::from_value(params)?;
    let (events, received) = channel();
    let from_editor = connection.receiver.clone();
    let of_messages: Sender<Event> = events.clone();
    thread::spawn(move || {
        for message in from_editor {
            if of_messages.send(Event::Message(message)).is_err() {
                return;
            }
        }
        // The loop may have ended before.
        let _ = of_messages.send(Event::End);
    });
    let questions = mechanism::examine(move |answer| {
        let _ = events.send(Event::Mechanism(answer));
    });
    let mut server = Server::new(connection, questions, root, &params);
    while let Ok(first) = received.recv() {
        for event in std::iter::once(first).chain(received.try_iter()) {
            match event {
                Event::End => return Ok(false),
                Event::Mechanism(answer) => server.mechanism(answer),
                Event::Message(Message::Request(request)) => {
                    if request.method == "shutdown" {
                        server.send(Message::Response(Response::new_ok(request.id, ())));
                        continue;
                    }
                    server.request(request);
                }
                Event::Message(Message::Notification(own)) if own.method == protocol::Exit::METHOD => return Ok(true),
                Event::Message(Message::Notification(own)) => server.notification(own),
                Event::Message(Message::Response(_)) => {}
            }
        }
        server.refresh();
    }
    Ok(false)
}

fn capabilities() -> ServerCapabilities {
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Kind(TextDocumentSyncKind::INCREMENTAL)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some([".", " ", "{", "["].map(str::to_owned).to_vec()),
            ..CompletionOptions::default()
        }),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(RenameOptions {
            prepare_provider: Some(true),
            work_done_progress_options: Default::default(),
        })),
        document_symbol_provider: Some(OneOf::Left(true)),
        folding_range_provider: Some(lsp_types::FoldingRangeProviderCapability::Simple(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        code_action_provider: Some(CodeActionProviderCapability::Options(CodeActionOptions {
            code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]),
            ..CodeActionOptions::default()
        })),
        ..ServerCapabilities::default()
    }
}

struct Server<'c> {
    connection: &'c Connection,
    workspace: Workspace,
    schema: Schema,
    snippets: bool,
    /// Models whose mechanisms are to be examined.
    questions: Sender<Question>,
    /// The reading of each model, and the error of its mechanism.
    mechanisms: BTreeMap<PathBuf, (u64, Option<MechanismError>)>,
    readings: u64,
    /// Diagnostics that the editor has.
    published: BTreeMap<PathBuf, Vec<Diagnostic>>,
}

impl<'c> Server<'c> {
    fn new(
        connection: &'c Connection,
        questions: Sender<Question>,
        root: Option<PathBuf>,
        params: &InitializeParams,
    ) -> Self {
        let folders = params.workspace_folders.iter().flatten().filter_map(|folder| path_of(&folder.uri)).collect();
        let completion = params.capabilities.text_document.as_ref().and_then(|own| own.completion.as_ref());
        let snippets = completion.and_then(|own| own.completion_item.as_ref()?.snippet_support).unwrap_or(false);
        Self {
            connection,
            workspace: Workspace::new(folders, root),
            schema: Schema::new(),
            snippets,
            questions,
            mechanisms: BTreeMap::new(),
            readings: 0,
            published: BTreeMap::new(),
        }
    }

    /// Sends a message; an editor that is gone ends the loop by itself.
    fn send(&self, message: Message) {
        let _ = self.connection.sender.send(message);
    }

    fn request(&mut self, request: Request) {
        self.refresh();
        let answers = Answers { workspace: &self.workspace, schema: &self.schema, snippets: self.snippets };
        let Request { id, method, params } = request;
        let answer = study::caught("the language server", || answers.answer(&method, params));
        let answer = answer.unwrap_or_else(|own| Err(error(ErrorCode::InternalError, own.to_string())));
        self.send(Message::Response(match answer {
            Ok(result) => Response::new_ok(id, result),
            Err(error) => Response { id, result: None, error: Some(error) },
        }));
    }

    fn notification(&mut self, own: Notification) {
        match own.method.as_str() {
            protocol::DidOpenTextDocument::METHOD => {
                let Some(DidOpenTextDocumentParams { text_document: own }) = read(own) else { return };
                let document = Document { text: Text::new(own.text), version: own.version, uri: own.uri };
                self.workspace.set(path_of_document(&document.uri), document);
            }
            protocol::DidChangeTextDocument::METHOD => {
                let Some(DidChangeTextDocumentParams { text_document, content_changes }) = read(own) else { return };
                let path = path_of_document(&text_document.uri);
                let Some(document) = self.workspace.documents.get(&path).cloned() else { return };
                let text = content_changes.into_iter().fold(document.text, |text, change| text.changed(change));
                self.workspace.set(path, Document { text, version: text_document.version, uri: document.uri });
            }
            protocol::DidCloseTextDocument::METHOD => {
                let Some(DidCloseTextDocumentParams { text_document }) = read(own) else { return };
                self.workspace.close(&path_of_document(&text_document.uri));
            }
            protocol::DidSaveTextDocument::METHOD | protocol::DidChangeWatchedFiles::METHOD => self.workspace.stale(),
            _ => {}
        }
    }

    /// Reads changed texts, and publishes their diagnostics.
    fn refresh(&mut self) {
        let read = match study::caught("reading", || self.workspace.refresh()) {
            Ok(read) if read.is_empty() && self.published.keys().all(|file| self.is_shown(file)) => return,
            Ok(read) => read,
            Err(own) => {
                self.log(&own.to_string());
                return;
            }
        };
        for path in read {
            self.readings += 1;
            let error = self.mechanisms.get(&path).and_then(|(_, error)| error.clone());
            let Some(model) = self.workspace.model(&path) else { continue };
            let reading = &model.opened.reading;
            let scenes = reading.scenes.iter().map(|own| (Some(own.name.clone()), Arc::new(own.description.clone())));
            let mut scenes: Vec<_> = scenes.collect();
            if let (true, Some(known)) = (scenes.is_empty() && reading.description.is_some(), &model.known) {
                scenes.push((None, Arc::clone(known)));
            }
            // The mechanism of a text with errors is not known.
            let error = error.filter(|_| !scenes.is_empty());
            self.mechanisms.insert(path.clone(), (self.readings, error));
            if !scenes.is_empty() && !model.is_made_up {
                // The thread lives as long as the server.
                let _ = self.questions.send(Question { path, reading: self.readings, scenes });
            }
        }
        self.publish();
    }

    fn mechanism(&mut self, answer: mechanism::Answer) {
        match self.mechanisms.get_mut(&answer.path) {
            Some((reading, error)) if *reading == answer.reading && *error != answer.error => *error = answer.error,
            _ => return,
        }
        self.publish();
    }

    fn is_shown(&self, file: &Path) -> bool {
        self.workspace.models().any(|model| model.has(file))
    }

    fn publish(&mut self) {
        let mut all: BTreeMap<PathBuf, Vec<Diagnostic>> = BTreeMap::new();
        for model in self.workspace.models() {
            let of_mechanism = self.mechanisms.get(&model.path).and_then(|(_, error)| error.as_ref());
            for (file, found) in of_model(&self.workspace, model, of_mechanism) {
                let known = all.entry(file).or_default();
                for diagnostic in found {
                    if !known.contains(&diagnostic) {
                        known.push(diagnostic);
                    }
                }
            }
        }
        for file in self.published.keys() {
            all.entry(file.clone()).or_default();
        }
        for (file, diagnostics) in &all {
            let is_open = self.workspace.documents.contains_key(file);
            if self.published.get(file).is_some_and(|known| known == diagnostics)
                || !is_open && diagnostics.is_empty() && !self.published.contains_key(file)
            {
                continue;
            }
            let Some(uri) = address(&self.workspace, file) else { continue };
            let version = self.workspace.documents.get(file).map(|own| own.version);
            let params = PublishDiagnosticsParams { uri, diagnostics: diagnostics.clone(), version };
            let method = protocol::PublishDiagnostics::METHOD.to_owned();
            self.send(Message::Notification(Notification::new(method, params)));
        }
        all.retain(|file, _| self.is_shown(file));
        self.published = all;
    }

    fn log(&self, message: &str) {
        let params = serde_json::json!({ "type": 1, "message": message });
        self.send(Message::Notification(Notification::new(protocol::LogMessage::METHOD.to_owned(), params)));
    }
}

fn read<P: DeserializeOwned>(own: Notification) -> Option<P> {
    serde_json::from_value(own.params).ok()
}
