//! Notes for the page: the latest of each topic, numbered, so that a page asks for the new ones only.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::tuning::TUNING;
use serde_json::{Map, Value, json};

#[derive(Default)]
struct Notes {
    /// Number of the latest note.
    latest: u64,
    topics: BTreeMap<&'static str, (u64, Value)>,
    is_ended: bool,
}

/// A notice board.
#[derive(Default)]
pub struct Board {
    notes: Mutex<Notes>,
    bell: Condvar,
}

impl Board {
    /// Locks the notes; a panic elsewhere leaves them consistent.
    fn lock(&self) -> MutexGuard<'_, Notes> {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Replaces the note on a topic, if the new one differs.
    pub fn put(&self, topic: &'static str, note: Value) {
        let mut notes = self.lock();
        if notes.topics.get(topic).is_some_and(|(_, known)| *known == note) {
            return;
        }
        notes.latest += 1;
        let number = notes.latest;
        notes.topics.insert(topic, (number, note));
        self.bell.notify_all();
    }

    /// All notes after a number, as soon as there are any, or after some time: `{latest, topics, ended}`. For the
    /// number of another session, all notes.
    pub fn after(&self, number: u64) -> Value {
        let notes = self.lock();
        let number = if number > notes.latest { 0 } else { number };
        let is_old = |notes: &mut Notes| notes.latest <= number && !notes.is_ended;
        let waited = self.bell.wait_timeout_while(notes, TUNING.patience_of_board, is_old);
        let (notes, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let new = notes.topics.iter().filter(|(_, (own, _))| *own > number);
        let topics: Map<String, Value> = new.map(|(topic, (_, note))| ((*topic).to_owned(), note.clone())).collect();
        json!({ "latest": notes.latest, "topics": topics, "ended": notes.is_ended })
    }

    /// Ends the board: no more notes follow.
    pub fn end(&self) {
        self.lock().is_ended = true;
        self.bell.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_receives_only_new_topics() {
        let board = Board::default();
        board.put("a", json!(1));
        board.put("b", json!(2));
        board.put("b", json!(2));
        assert_eq!(board.after(0), json!({ "latest": 2, "topics": { "a": 1, "b": 2 }, "ended": false }));
        assert_eq!(board.after(99)["latest"], 2, "a number of another session");
        board.put("a", json!(3));
        assert_eq!(board.after(2)["topics"], json!({ "a": 3 }));
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| board.after(3));
            board.put("c", json!("new"));
            assert_eq!(waiting.join().unwrap()["topics"], json!({ "c": "new" }));
        });
        board.end();
        assert_eq!(board.after(4), json!({ "latest": 4, "topics": {}, "ended": true }));
    }
}
