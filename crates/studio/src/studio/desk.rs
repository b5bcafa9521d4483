//! The state shared by page and workers: the texts, the last model without errors, its results, notes and questions.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::Value;

use super::board::Board;
use super::questions::{Move, Values};
use super::requests::Requests;
use super::texts::{Followed, TextError, Texts};
use super::tuning::TUNING;
use crate::model::Description;
use crate::results::{Bounds, Summary};
use crate::syntax::within::OpenTexts;

/// A model that could be read.
pub struct Current {
    /// Its number, greater than those of earlier models.
    pub number: u64,
    /// The model, or one of its scenes.
    pub description: Description,
}

/// A finished study.
pub struct Finished {
    /// The model.
    pub current: Arc<Current>,
    /// Its results.
    pub bounds: Bounds,
    /// Their summary.
    pub summary: Summary,
}

/// The texts and choices from which a model is read.
pub struct Reading {
    /// Number of the change to read.
    pub change: u64,
    /// The model's full path.
    pub path: PathBuf,
    /// Open texts.
    pub overlay: OpenTexts,
    /// The scene that was chosen.
    pub scene: Option<String>,
    /// Whether long studies and programs of this text are allowed.
    pub is_allowed: bool,
}

struct State {
    texts: Texts,
    changed: Instant,
    scene: Option<String>,
    is_allowed: bool,
    current: Option<Arc<Current>>,
    finished: Option<Arc<Finished>>,
    /// All files that the model was read from.
    sources: Vec<PathBuf>,
}

/// The shared state of a session.
pub struct Desk {
    /// Notes for the page.
    pub board: Board,
    /// Samples that the page wants.
    pub samples: Requests<Values>,
    /// Motions that the page wants.
    pub moves: Requests<Move>,
    /// Folder whose files the model may name, in addition to its own folder.
    pub root: Option<PathBuf>,
    /// A folder for results, which is deleted with the session.
    pub folder: PathBuf,
    state: Mutex<State>,
    bell: Condvar,
    /// Number of the latest change.
    change: AtomicU64,
    /// Number of the current model.
    number: AtomicU64,
    is_ended: AtomicBool,
}

impl Desk {
    /// A desk with the texts of a model.
    pub fn new(texts: Texts, root: Option<PathBuf>, folder: PathBuf) -> Self {
        let (scene, current, finished, sources) = (None, None, None, Vec::new());
        let state = State { texts, changed: Instant::now(), scene, is_allowed: false, current, finished, sources };
        Self {
            board: Board::default(),
            samples: Requests::default(),
            moves: Requests::default(),
            root,
            folder,
            state: Mutex::new(state),
            bell: Condvar::new(),
            change: AtomicU64::new(1),
            number: AtomicU64::new(0),
            is_ended: AtomicBool::new(false),
        }
    }

    /// Locks the state, which is consistent between any two statements of its users, even after a panic.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The texts.
    pub fn texts<T>(&self, of: impl FnOnce(&mut Texts) -> T) -> T {
        of(&mut self.lock().texts)
    }

    fn changed(&self, state: &mut State) {
        state.changed = Instant::now();
        self.change.fetch_add(1, Ordering::Relaxed);
        self.bell.notify_all();
    }

    /// Changes a text. A permission applies to one text only.
    ///
    /// # Errors
    /// If it is not open.
    pub fn write(&self, path: &Path, text: String) -> Result<(), TextError> {
        let mut state = self.lock();
        state.texts.change(path, text)?;
        state.is_allowed = false;
        self.changed(&mut state);
        Ok(())
    }

    /// Reads a text from the disk again.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn load(&self, path: &Path) -> Result<(), TextError> {
        let mut state = self.lock();
        state.texts.load(path)?;
        state.is_allowed = false;
        self.changed(&mut state);
        Ok(())
    }

    /// Takes over the text of a file that another program has written.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn follow(&self, path: &Path) -> Result<Followed, TextError> {
        let mut state = self.lock();
        let followed = state.texts.follow(path)?;
        if matches!(followed, Followed::Loaded(_) | Followed::Other) {
            state.is_allowed = false;
            self.changed(&mut state);
        }
        Ok(followed)
    }

    /// All files that the model was read from.
    pub fn sources(&self) -> Vec<PathBuf> {
        self.lock().sources.clone()
    }

    /// Sets the files from which the model was read, and those of them that are texts of the language.
    pub fn was_read_from(&self, sources: Vec<PathBuf>, texts: Vec<PathBuf>) {
        let mut state = self.lock();
        state.texts.consists_of(texts);
        state.sources = sources;
    }

    /// Allows a long study, or the start of a program, for the present text.
    pub fn allow(&self) {
        let mut state = self.lock();
        state.is_allowed = true;
        self.changed(&mut state);
    }

    /// Chooses a scene.
    pub fn choose(&self, scene: String) {
        let mut state = self.lock();
        state.scene = Some(scene);
        self.changed(&mut state);
    }

    /// Waits for a change other than `seen`, and for a pause in typing; `None` at the end.
    pub fn next_change(&self, seen: u64) -> Option<Reading> {
        let mut state = self.lock();
        while !self.has_ended() {
            let change = self.change.load(Ordering::Relaxed);
            // The first text is read at once.
            if change != seen && (seen == 0 || state.changed.elapsed() >= TUNING.quiet) {
                let (path, overlay) = (state.texts.model().to_owned(), state.texts.overlay());
                let (scene, is_allowed) = (state.scene.clone(), state.is_allowed);
                return Some(Reading { change, path, overlay, scene, is_allowed });
            }
            state =
                self.bell.wait_timeout(state, TUNING.between_looks_of_desk).unwrap_or_else(PoisonError::into_inner).0;
        }
        None
    }

    /// Whether a change is no longer the latest.
    pub fn is_old(&self, change: u64) -> bool {
        self.has_ended() || self.change.load(Ordering::Relaxed) != change
    }

    /// Makes a model the current one, and puts its note on the board: under the lock, so that a page or a worker that
    /// learns of it finds it to be the current one.
    pub fn publish(&self, number: u64, description: Description, note: Value) -> Arc<Current> {
        let current = Arc::new(Current { number, description });
        let mut state = self.lock();
        self.number.store(number, Ordering::Relaxed);
        state.current = Some(Arc::clone(&current));
        self.board.put("model", note);
        drop(state);
        self.bell.notify_all();
        current
    }

    /// Waits for a model other than `seen`; `None` at the end.
    pub fn next_model(&self, seen: u64) -> Option<Arc<Current>> {
        let mut state = self.lock();
        while !self.has_ended() {
            if let Some(current) = state.current.as_ref().filter(|current| current.number != seen) {
                return Some(Arc::clone(current));
            }
            state =
                self.bell.wait_timeout(state, TUNING.between_looks_of_desk).unwrap_or_else(PoisonError::into_inner).0;
        }
        None
    }

    /// The current model, if one could be read.
    pub fn current(&self) -> Option<Arc<Current>> {
        self.lock().current.clone()
    }

    /// Whether a model is no longer the current one.
    pub fn is_replaced(&self, number: u64) -> bool {
        self.has_ended() || self.number.load(Ordering::Relaxed) != number
    }

    /// Stores the results of a study.
    pub fn finish(&self, finished: Finished) {
        self.lock().finished = Some(Arc::new(finished));
    }

    /// The results of the latest finished study.
    pub fn finished(&self) -> Option<Arc<Finished>> {
        self.lock().finished.clone()
    }

    /// Ends the workers, and notifies the page.
    pub fn end(&self) {
        self.is_ended.store(true, Ordering::Relaxed);
        self.bell.notify_all();
        self.board.end();
    }

    /// Whether the session has ended.
    pub fn has_ended(&self) -> bool {
        self.is_ended.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use std::thread::{scope, yield_now};

    use serde_json::json;

    use super::*;
    use crate::model::load_str;

    /// A page and a worker that learn of a model find it to be the current one, whenever they are scheduled.
    #[test]
    fn known_model_is_the_current_one() {
        let models = 20_000;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.yaml");
        std::fs::write(&path, "").unwrap();
        let desk = Desk::new(Texts::new(path).unwrap(), None, folder.path().to_owned());
        let text = "bodies: { b: { mass: 1, coordinates: [x] } }\noutputs: { x: b.x }\n\
                    simulation: { duration: 1, step: 0.1 }\n";
        let description = load_str("m.yaml", text, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        scope(|scope| {
            scope.spawn(|| {
                (1..=models).for_each(|number| {
                    desk.publish(number, description.clone(), json!(number));
                });
            });
            scope.spawn(|| {
                let mut seen = 0;
                while seen < models {
                    let Some(current) = desk.next_model(seen) else { panic!("the desk has not ended") };
                    seen = current.number;
                    if desk.is_replaced(seen) {
                        assert!(desk.current().is_some_and(|own| own.number > seen), "{seen} is replaced by nothing");
                    }
                }
            });
            let mut noted = 0;
            while noted < models {
                let board = desk.board.after(0);
                noted = board["topics"]["model"].as_u64().unwrap_or(0);
                assert!(noted == 0 || desk.current().is_some_and(|own| own.number >= noted), "{noted} is not current");
                yield_now();
            }
        });
    }
}
