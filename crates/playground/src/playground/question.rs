//! Questions of a page.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use crate::model::{Opened, read_open};
use crate::syntax::within::OpenTexts;

/// A model, and the task.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) struct Question {
    pub task: Task,
    /// Path of the model among the files.
    pub model: String,
    /// The scene to run; if absent the first one, or the model itself if it has no scenes.
    #[serde(default)]
    pub scene: Option<String>,
    /// Whether a run may take long.
    #[serde(default)]
    pub costly: bool,
    /// Texts by their paths: the model, and the files that it may name.
    pub files: BTreeMap<String, String>,
}

/// Task for a model.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(super) enum Task {
    /// Read it.
    Check,
    /// Read it, run it and show the results.
    Run,
}

impl Question {
    /// The model, read from the texts.
    pub fn read(&self) -> Opened {
        let texts = self.files.iter().map(|(path, text)| (PathBuf::from(path), text.clone()));
        read_open(self.model.as_ref(), &OpenTexts::new(texts), None)
    }
}
