//! Contents of a folder of an older run.

use std::path::Path;

use serde::Deserialize;

use super::folder::settle;
use super::owned::{SCENES, SUMMARY, is_plain, read};

/// Contents of a summary, or of a list of scenes, of an older run.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Earlier {
    model: String,
    interrupted: bool,
    /// Folders of the scenes.
    scenes: Vec<String>,
}

impl Earlier {
    /// Contents of a file; empty if there is no such file that can be read.
    fn of(dir: &Path, file: &str) -> Self {
        read(&dir.join(file)).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
    }
}

/// Whether a folder holds the results of a run that was not interrupted.
pub fn holds_complete_results(dir: &Path) -> bool {
    // The next writer completes the work that a killed run left, or reports it.
    let _ = settle(dir);
    let earlier = Earlier::of(dir, SUMMARY);
    !earlier.model.is_empty() && !earlier.interrupted
}

/// Folders of the scenes that an older run had.
pub(super) fn scene_folders(dir: &Path) -> Vec<String> {
    Earlier::of(dir, SCENES).scenes.into_iter().filter(|name| is_plain(name)).collect()
}
