//! Errors of mechanisms as a whole: a thread next to the server's loop builds and assembles their equations.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use super::tuning::TUNING;
use crate::model::Description;
use crate::study;
use crate::syntax::{Code, Coded};

/// A model to be examined.
pub struct Question {
    /// Its file.
    pub path: PathBuf,
    /// Number of the reading.
    pub reading: u64,
    /// Its scenes with their names; the model itself without a name if it has no scenes.
    pub scenes: Vec<(Option<String>, Arc<Description>)>,
}

/// The first error of a mechanism.
pub struct Answer {
    /// The model's file.
    pub path: PathBuf,
    /// Number of the reading.
    pub reading: u64,
    /// The first error.
    pub error: Option<MechanismError>,
}

/// The error of a mechanism as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MechanismError {
    /// As `mbint check` prints it.
    pub message: String,
    /// The kind of mistake.
    pub code: Option<Code>,
}

/// Starts a thread that examines the latest reading of each model and passes each answer to `answer`. It ends when the
/// returned sender is dropped.
pub fn examine(answer: impl Fn(Answer) + Send + 'static) -> Sender<Question> {
    let (questions, received): (Sender<Question>, Receiver<Question>) = channel();
    thread::spawn(move || {
        while let Ok(first) = received.recv() {
            let mut latest = BTreeMap::from([(first.path.clone(), first)]);
            // Equations are not built while someone types.
            while let Ok(next) = received.recv_timeout(TUNING.quiet) {
                latest.insert(next.path.clone(), next);
            }
            for Question { path, reading, scenes } in latest.into_values() {
                answer(Answer { path, reading, error: scenes.iter().find_map(|(name, model)| error(name, model)) });
            }
        }
    });
    questions
}

/// The error of a mechanism.
fn error(scene: &Option<String>, model: &Description) -> Option<MechanismError> {
    let checked = study::caught("check", || {
        study::ready(model)?;
        study::structure(model).map(|_| ())
    });
    let (message, code) = match checked {
        Ok(Ok(())) => return None,
        Ok(Err(error)) => (error.to_string(), error.code()),
        Err(error) => (error.to_string(), None),
    };
    let message = scene.as_ref().map_or_else(|| message.clone(), |name| format!("scene {name}: {message}"));
    Some(MechanismError { message, code })
}
