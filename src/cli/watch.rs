//! `mbint run --watch`: runs again when a model's files change, and prints the bounds that moved.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::SystemTime;

use super::console::{BOLD, Console, count};
use super::job::Done;
use super::request::{Job, Request};
use super::run::run_all;
use super::snapshot::moves;
use super::tuning::TUNING;
use super::{Failure, Status, interrupt};
use crate::export::{Snapshot, moved, snapshot_table};
use crate::model::{self, Changes, is_standard_input};

/// Identifies the state of a file: time of its last change, and length; `None` without a file.
type Mark = Option<(SystemTime, u64)>;

pub(super) fn watch(mut request: Request, console: &mut Console) -> Result<Status, Failure> {
    if request.models.iter().any(|path| is_standard_input(path)) {
        return Err(Failure::wrong("standard input does not change: --watch needs a file"));
    }
    let is_quiet = request.quiet;
    let mut known: BTreeMap<String, Snapshot> = BTreeMap::new();
    loop {
        // Before reading, so that changes in the meantime are seen.
        let before = marks(&request);
        let mut changes = String::new();
        let mut told = |_: &Path, job: &Job, done: Result<&Done, &Failure>| {
            if let Ok(done) = done
                && done.summary.failure.is_none()
                && let Ok(now) = Snapshot::read(&snapshot_table(&done.bounds))
            {
                let name = &job.model.name;
                if let Some(then) = known.insert(name.clone(), now) {
                    changes += &told_of(name, &moves(&moved(&then, &known[name])));
                }
            }
        };
        let status = run_all(&request, console, &mut told).unwrap_or_else(|failure| console.failure(&failure));
        if !is_quiet {
            console.print(&changes)?;
            let files = count(before.len(), "file", "files");
            console.print(&format!("watching {files}; Ctrl-C ends\n"))?;
        }
        if status == Status::Interrupted || !changed(&request, before) {
            return Ok(Status::Interrupted);
        }
        // From now on the changes are enough.
        request.quiet = true;
    }
}

/// Text for a model or a scene, with its moved bounds.
fn told_of(name: &str, moves: &str) -> String {
    match moves {
        "" => format!("{BOLD}{name}{BOLD:#}: run again, and no bound moved by more than the stated errors\n"),
        moves => format!("{BOLD}{name}{BOLD:#}: run again\n\n{moves}\n"),
    }
}

/// Waits until a file changes; `false` at an interruption.
fn changed(request: &Request, before: BTreeMap<PathBuf, Mark>) -> bool {
    // An interruption ends the waiting here, instead of the program at any point.
    interrupt::keep_results(true);
    while !interrupt::asked() {
        sleep(TUNING.between_looks_at_files);
        if before.iter().any(|(path, mark)| mark_of(path) != *mark) {
            settle(request);
            interrupt::keep_results(false);
            return !interrupt::asked();
        }
    }
    false
}

/// Waits until the files are stable: an editor may write in parts, or replace a file.
fn settle(request: &Request) {
    let mut last = marks(request);
    while !interrupt::asked() {
        sleep(TUNING.between_looks_at_files);
        let now = marks(request);
        if now == last {
            return;
        }
        last = now;
    }
}

/// The models' files, and the files that they name.
fn marks(request: &Request) -> BTreeMap<PathBuf, Mark> {
    let mut marks = BTreeMap::new();
    for path in &request.models {
        let reading = model::read_rooted(path, Changes::of(&request.given.overrides), request.given.root.as_deref());
        let named = reading.diagnostics.sources.all().map(|source| PathBuf::from(&source.name));
        // Texts of the command line are not files.
        let named = named.filter(|path| path.is_file()).chain([path.clone()]);
        marks.extend(named.map(|path| (path.clone(), mark_of(&path))));
    }
    marks
}

fn mark_of(path: &Path) -> Mark {
    let data = fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}
