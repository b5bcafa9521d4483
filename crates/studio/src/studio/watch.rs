//! Files that another program changes: a text that the page has not changed follows the disk, others stay.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::SystemTime;

use serde_json::{Value, json};

use super::desk::Desk;
use super::language::Language;
use super::texts::Followed;
use super::tuning::TUNING;

/// Identifies the state of a file: time of its last change, and length; `None` without a file.
type Mark = Option<(SystemTime, u64)>;

fn mark(path: &Path) -> Mark {
    let data = fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// Polls the model's files until the end.
pub fn work(desk: &Desk, language: &Language) {
    let mut marks: BTreeMap<PathBuf, Mark> = BTreeMap::new();
    let mut notes: BTreeMap<String, Value> = BTreeMap::new();
    let mut changes = 0;
    while !desk.has_ended() {
        sleep(TUNING.between_looks_at_files);
        for path in desk.sources() {
            let now = mark(&path);
            let is_as_it_was = match marks.insert(path.clone(), now) {
                Some(before) => before == now,
                // An open text may be older than the first check of its file.
                None => !desk.texts(|texts| texts.is_open(&path)),
            };
            if is_as_it_was {
                continue;
            }
            let Ok(followed) = desk.follow(&path) else { continue };
            let text = match followed {
                Followed::Same => continue,
                Followed::Other => {
                    language.saved(&path);
                    continue;
                }
                Followed::Loaded(text) => {
                    language.open(&path, &text);
                    Some(text)
                }
                Followed::Kept => None,
            };
            changes += 1;
            notes.insert(path.to_string_lossy().into_owned(), json!({ "change": changes, "text": text }));
            desk.board.put("disk", json!(notes));
        }
    }
}
