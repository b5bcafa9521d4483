//! The language server, which runs in the studio, and its client.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use super::tuning::TUNING;
use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use mbint_lsp::{attend, uri_of};
use serde_json::{Value, json};

/// Requests of the page that are passed on, since they change nothing.
pub const METHODS: [&str; 7] = [
    "textDocument/completion",
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/documentSymbol",
    "textDocument/formatting",
    "textDocument/codeAction",
];

type Waiting = Arc<Mutex<HashMap<RequestId, Sender<Response>>>>;

/// A client of the language server.
pub struct Language {
    connection: Connection,
    waiting: Waiting,
    last: AtomicI32,
    version: AtomicI32,
}

impl Language {
    /// Starts the server, and passes the diagnostics of each file to `publish`: the file's address, and the list.
    pub fn start(root: Option<PathBuf>, publish: impl Fn(String, Value) + Send + 'static) -> Arc<Self> {
        let (own, connection) = Connection::memory();
        // It ends with the connection.
        thread::spawn(move || attend(&own, root));
        let waiting = Waiting::default();
        let (received, answers) = (connection.receiver.clone(), Arc::clone(&waiting));
        thread::spawn(move || {
            for message in received {
                match message {
                    Message::Response(response) => {
                        let asked = answers.lock().unwrap_or_else(PoisonError::into_inner).remove(&response.id);
                        asked.map(|asked| asked.send(response));
                    }
                    Message::Notification(own) if own.method == "textDocument/publishDiagnostics" => {
                        let uri = own.params["uri"].as_str().unwrap_or_default().to_owned();
                        publish(uri, own.params["diagnostics"].clone());
                    }
                    _ => {}
                }
            }
        });
        let language = Self { connection, waiting, last: AtomicI32::new(0), version: AtomicI32::new(1) };
        let capabilities =
            json!({ "textDocument": { "completion": { "completionItem": { "snippetSupport": false } } } });
        // Its capabilities are known already.
        let _ = language.ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        language.tell("initialized", json!({}));
        Arc::new(language)
    }

    /// The answer to a request.
    ///
    /// # Errors
    /// Those of the server, and if it does not answer.
    pub fn ask(&self, method: &str, params: Value) -> Result<Value, String> {
        let id = RequestId::from(self.last.fetch_add(1, Ordering::Relaxed));
        let (answer, answered) = channel();
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner).insert(id.clone(), answer);
        let gone = || "the language server does not answer".to_owned();
        let request = Request { id, method: method.to_owned(), params };
        self.connection.sender.send(Message::Request(request)).map_err(|_| gone())?;
        let response = answered.recv_timeout(TUNING.patience_of_language).map_err(|_| gone())?;
        match response.error {
            Some(error) => Err(error.message),
            None => Ok(response.result.unwrap_or_default()),
        }
    }

    /// Notifies the server that a file is open, with a text.
    pub fn open(&self, path: &Path, text: &str) {
        let version = self.version.fetch_add(1, Ordering::Relaxed);
        let document = json!({ "uri": uri(path), "languageId": "yaml", "version": version, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Notifies the server that files on the disk have changed.
    pub fn saved(&self, path: &Path) {
        self.tell("textDocument/didSave", json!({ "textDocument": { "uri": uri(path) } }));
    }

    fn tell(&self, method: &str, params: Value) {
        // Ignored if the server has ended.
        let _ = self.connection.sender.send(Message::Notification(Notification::new(method.to_owned(), params)));
    }
}

/// The address by which the server knows a file.
pub fn uri(path: &Path) -> String {
    uri_of(path).map_or_else(String::new, |uri| uri.as_str().to_owned())
}
