//! What a page asks.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use crate::model::{Opened, read_open};
use crate::syntax::within::OpenTexts;

/// A model and what to do with it.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) struct Question {
    pub task: Task,
    /// Path of the model among the files.
    pub model: String,
    /// The scene to run; the first where it is absent, or none of the model.
    #[serde(default)]
    pub scene: Option<String>,
    /// Whether a run may take long.
    #[serde(default)]
    pub costly: bool,
    /// Texts by their paths: the model, and the files that it may name.
    pub files: BTreeMap<String, String>,
}

/// What to do with a model.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(super) enum Task {
    /// To read it.
    Check,
    /// To read it, run it and show the results.
    Run,
}

impl Question {
    /// The model, read from the texts.
    pub fn read(&self) -> Opened {
        let texts = self.files.iter().map(|(path, text)| (PathBuf::from(path), text.clone()));
        read_open(self.model.as_ref(), &OpenTexts::new(texts), None)
    }
}
