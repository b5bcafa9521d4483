//! A session: from the port to the end.

use std::collections::BTreeMap;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use serde_json::{Value, json};

use super::answer::Answer;
use super::connection::Connection;
use super::desk::Desk;
use super::guard::Guard;
use super::language::Language;
use super::routes::Routes;
use super::texts::{TextError, Texts};
use super::tuning::TUNING;
use super::{bounds, moves, samples, watch};
use crate::study;

/// Options of a session.
pub struct Options<'o> {
    /// The model's file.
    pub model: &'o Path,
    /// Folder whose files the model may name, in addition to its own folder.
    pub root: Option<PathBuf>,
    /// The port; 0 for any free one.
    pub port: u16,
    /// Called with the address of the page, once it is served.
    pub started: &'o mut dyn FnMut(&str),
    /// Polled for the end of the session.
    pub is_ended: &'o dyn Fn() -> bool,
}

/// Reasons why there is no session.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// The model's file cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The model's path has no full form.
    #[error("the model's path cannot be completed: {0}")]
    Path(io::Error),
    /// There is no such port.
    #[error("port {0} of this machine cannot be listened at: {1}. Choose another by --port, or none")]
    Port(u16, io::Error),
    /// No folder for results.
    #[error("there is no folder for results: {0}")]
    Folder(io::Error),
    /// No token.
    #[error("the system has no random numbers for the token: {0}")]
    Random(#[from] getrandom::Error),
}

/// Serves the page of a model until the end.
///
/// # Errors
/// If the file cannot be read, or the port cannot be listened at.
pub fn serve(options: Options) -> Result<(), StudioError> {
    let Options { model, root, port, started, is_ended } = options;
    let path = std::path::absolute(model).map_err(StudioError::Path)?;
    let texts = Texts::new(path)?;
    let folder = tempfile::tempdir().map_err(StudioError::Folder)?;
    let failed = |error| StudioError::Port(port, error);
    // On the loopback interface only.
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(failed)?;
    let address = listener.local_addr().map_err(failed)?;
    let guard = Guard::new(address.port())?;
    let desk = Arc::new(Desk::new(texts, root.clone(), folder.path().to_owned()));
    let diagnostics = Mutex::new(BTreeMap::<String, Value>::new());
    let told = Arc::clone(&desk);
    let language = Language::start(root, move |uri, list| {
        let mut all = diagnostics.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert(uri, list);
        told.board.put("diagnostics", json!(*all));
    });
    for work in [bounds::work, moves::work, samples::work] {
        let desk = Arc::clone(&desk);
        // They end with the desk, at the latest with the program.
        thread::spawn(move || work(&desk));
    }
    let (watched, listening) = (Arc::clone(&desk), Arc::clone(&language));
    thread::spawn(move || watch::work(&watched, &listening));
    let routes = Arc::new(Routes { desk: Arc::clone(&desk), language });
    let page = guard.address();
    thread::spawn(move || listen(&listener, &Arc::new(guard), &routes));
    started(&page);
    while !is_ended() {
        thread::sleep(TUNING.between_looks_of_server);
    }
    desk.end();
    settle(address);
    Ok(())
}

/// Wakes the listener, and gives waiting pages time to receive the end.
fn settle(address: SocketAddr) {
    let _ = TcpStream::connect(address);
    thread::sleep(TUNING.between_looks_of_server);
}

/// Answers each connection in a thread of its own, until the studio ends.
fn listen(listener: &TcpListener, guard: &Arc<Guard>, routes: &Arc<Routes>) {
    let open = Arc::new(AtomicUsize::new(0));
    // Broken connections are skipped.
    for stream in listener.incoming().flatten() {
        if routes.desk.has_ended() {
            return;
        }
        // Connections beyond the limit are closed.
        if open.load(Ordering::Relaxed) >= TUNING.connections {
            continue;
        }
        open.fetch_add(1, Ordering::Relaxed);
        let (open, guard, routes) = (Arc::clone(&open), Arc::clone(guard), Arc::clone(routes));
        thread::spawn(move || {
            // `open` itself answers a head that cannot be read.
            if let Ok(connection) = Connection::open(stream) {
                attend(&guard, &routes, connection);
            }
            open.fetch_sub(1, Ordering::Relaxed);
        });
    }
}

/// Refuses a request, or answers it.
fn attend(guard: &Guard, routes: &Routes, mut connection: Connection) {
    let admitted = guard.admit(connection.head.caller());
    let admitted = admitted.map(|(path, query)| (path.to_owned(), query.to_owned()));
    let answer = match admitted {
        Err(refusal) => Answer::error(403, &refusal.to_string()),
        Ok((path, query)) => connection.body().map_or_else(
            |error| error,
            |body| {
                let method = connection.head.method.as_str();
                let answer = study::caught("the studio", || routes.answer(method, &path, &query, &body));
                answer.unwrap_or_else(|error| Answer::error(500, &error.to_string()))
            },
        ),
    };
    connection.answer(&answer);
}
