//! Which files of a folder are an older run's: its summary, or its list of scenes, says so.

use std::fs;
use std::path::Path;

use serde::Deserialize;

/// The summary's file.
pub const SUMMARY: &str = "summary.json";

/// The report's file: of whatever run, it is made of the other files.
pub(super) const PAGE: &str = "report.html";

/// The file that lists the scenes.
pub(super) const SCENES: &str = "scenes.json";

/// Version of the results' files: greater when a key or a column goes or changes its meaning. New ones do not count.
pub(super) const SCHEMA: u32 = 1;

/// What an older run says of itself.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Earlier {
    model: String,
    interrupted: bool,
    /// Folders of the scenes.
    scenes: Vec<String>,
    files: Vec<String>,
}

impl Earlier {
    /// Nothing where there is no such file that can be read.
    fn of(dir: &Path, file: &str) -> Self {
        let text = fs::read(dir.join(file)).unwrap_or_default();
        serde_json::from_slice(&text).unwrap_or_default()
    }
}

/// Whether a folder holds the results of a run that was not interrupted.
pub fn holds_complete_results(dir: &Path) -> bool {
    let earlier = Earlier::of(dir, SUMMARY);
    !earlier.model.is_empty() && !earlier.interrupted
}

/// Names of all files in a folder that older runs wrote, be it of a model or of its scenes.
pub(super) fn owned(dir: &Path) -> Vec<String> {
    let listed: Vec<String> = [SUMMARY, SCENES].into_iter().flat_map(|file| Earlier::of(dir, file).files).collect();
    // A report may have been made after its run.
    let page = (!listed.is_empty()).then(|| PAGE.to_owned());
    listed.into_iter().chain(page).collect()
}

/// Folders of the scenes that an older run had.
pub(super) fn scene_folders(dir: &Path) -> Vec<String> {
    let plain = |name: &String| Path::new(name).file_name().is_some_and(|plain| plain == name.as_str());
    Earlier::of(dir, SCENES).scenes.into_iter().filter(plain).collect()
}

/// Removes a scene's results. What is not of its run stays, and so then does the folder.
pub(super) fn remove_scene(folder: &Path) {
    for file in
        owned(folder).iter().filter(|name| Path::new(name).file_name().is_some_and(|plain| plain == name.as_str()))
    {
        // What cannot be removed is in nobody's way.
        let _ = fs::remove_file(folder.join(file));
    }
    let _ = fs::remove_dir(folder);
}
