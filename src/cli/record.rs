//! Output of `mbint run --format json` for each model or scene.

use std::fs;
use std::path::Path;

use serde::Serialize;

use super::Failure;
use super::job::Done;
use super::request::Job;
use crate::export::SUMMARY;
use crate::model;
use crate::syntax::Code;

/// Outcome of a model or a scene.
#[derive(Serialize)]
pub(super) struct Record {
    /// The model's file.
    file: String,
    /// The model's name, and the scene's after a slash.
    model: String,
    /// Exit code of the command if it had run this alone.
    exit_code: u8,
    /// Reason why there are no results.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// The code of that error.
    #[serde(skip_serializing_if = "Option::is_none")]
    error_code: Option<Code>,
    /// Folder of the results.
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    /// Contents of `summary.json`.
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<serde_json::Value>,
}

impl Record {
    /// The record of a job that ended.
    pub fn of(path: &Path, job: &Job, done: Result<&Done, &Failure>) -> Self {
        let nothing = Self {
            file: model::shown(path),
            model: job.model.name.clone(),
            exit_code: 0,
            error: None,
            error_code: None,
            folder: None,
            summary: None,
        };
        match done {
            Ok(done) => {
                // From the written file, so that both agree.
                let summary =
                    fs::read(done.folder.join(SUMMARY)).ok().and_then(|text| serde_json::from_slice(&text).ok());
                let folder = Some(done.folder.display().to_string());
                Self { exit_code: done.status.code(), folder, summary, ..nothing }
            }
            Err(failure) => Self {
                exit_code: failure.status().code(),
                error: Some(failure.message().to_owned()),
                error_code: failure.code(),
                ..nothing
            },
        }
    }
}
