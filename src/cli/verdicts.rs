//! Requirements of a run: the command that shows a sample, exit status, JUnit file.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::load::Given;
use super::{Failure, Status};
use crate::export::{Suite, write_junit};
use crate::model::{is_standard_input, shown};
use crate::results::{RequirementSummary, Summary, Verdict};

/// Collector of verdicts for a file.
pub(super) struct Junit {
    path: PathBuf,
    suites: Mutex<Vec<Suite>>,
}

impl Junit {
    pub fn new(path: PathBuf) -> Self {
        Self { path, suites: Mutex::default() }
    }

    /// Adds a model's requirements, or the reason why there are no verdicts.
    pub fn add(&self, model: &str, outcome: Result<&Summary, &str>) {
        let suite = match outcome {
            Ok(summary) => Suite::of_requirements(model, &summary.requirements),
            Err(why) => Suite::failed(model, why),
        };
        self.suites.lock().unwrap_or_else(PoisonError::into_inner).push(suite);
    }

    /// Writes all verdicts.
    pub fn write(&self) -> Result<(), Failure> {
        let suites = self.suites.lock().unwrap_or_else(PoisonError::into_inner);
        write_junit(&self.path, &suites).map_err(|error| Failure::failed(&error).of(&error))
    }
}

/// Status that follows from the requirements.
pub(super) fn status(summary: &Summary) -> Status {
    let of = |requirement: &RequirementSummary| match requirement.verdict {
        Verdict::Holds => Status::Done,
        Verdict::Undecided => Status::Unresolved,
        Verdict::Violated => Status::NotMet,
    };
    summary.requirements.iter().map(of).max().unwrap_or(Status::Done)
}

/// Adds the command that shows each requirement's nearest sample.
pub(super) fn add_commands(summary: &mut Summary, path: &Path, given: &Given) {
    if is_standard_input(path) {
        return;
    }
    let scene = summary.model.split_once('/').map(|(_, scene)| scene.to_owned());
    for nearest in summary.requirements.iter_mut().filter_map(|requirement| requirement.nearest.as_mut()) {
        let mut words = vec!["mbint".to_owned(), "run".to_owned(), quoted(&shown(path))];
        if let Some(scene) = &scene {
            words.extend(["--scene".to_owned(), quoted(scene)]);
        }
        if let Some(root) = &given.root {
            words.extend(["--root".to_owned(), quoted(&shown(root))]);
        }
        let is_set = |name: &str| nearest.settings.iter().any(|setting| setting.split('=').next() == Some(name));
        let others =
            given.overrides.iter().filter(|setting| !is_set(&setting.name)).map(|setting| setting.text.as_str());
        for setting in others.chain(nearest.settings.iter().map(String::as_str)) {
            words.extend(["--set".to_owned(), quoted(setting)]);
        }
        nearest.command = words.join(" ");
    }
}

/// Quotes a word of a command line.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-./=+,:".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}
