//! The list of our files in a folder: those that a run wrote there, if they are unchanged.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use data_encoding::HEXLOWER;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::tuning::TUNING;
use crate::syntax::text_file::regular;

/// The summary's file.
pub const SUMMARY: &str = "summary.json";

/// The file of the proof of certified bounds.
pub(super) const CERTIFICATE: &str = "certificate.jsonl";

/// The report's file: of any run, it is made of the other files.
pub(super) const PAGE: &str = "report.html";

/// The file that lists the scenes.
pub(super) const SCENES: &str = "scenes.json";

/// The list of files that are ours.
pub(super) const OWNED: &str = ".mbint.json";

/// Version of the results' files: greater when a key or a column goes or changes its meaning. New ones do not count.
pub(super) const SCHEMA: u32 = 1;

/// Files that runs wrote into a folder, and that the next one may remove.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Owned {
    /// SHA-256 by name.
    pub files: BTreeMap<String, String>,
    /// Folders of scenes, each with a list of its own.
    pub scenes: Vec<String>,
}

impl Owned {
    /// The list of a folder; empty if there is no such list that can be read. Names of other folders' files are
    /// omitted.
    pub fn of(dir: &Path) -> Self {
        let mut own: Self =
            read(&dir.join(OWNED)).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default();
        own.files.retain(|name, _| is_plain(name));
        own.scenes.retain(|name| is_plain(name));
        own
    }

    /// Files that exist and are unchanged.
    pub fn unchanged(&self, dir: &Path) -> Vec<String> {
        let is_ours = |name: &&String| read(&dir.join(name)).is_ok_and(|bytes| sha256(&bytes) == self.files[*name]);
        self.files.keys().filter(is_ours).cloned().collect()
    }

    /// The list in its file.
    ///
    /// # Errors
    /// Only if memory cannot be written to.
    pub fn to_json(&self) -> serde_json::Result<Vec<u8>> {
        let mut json = serde_json::to_vec_pretty(self)?;
        json.push(b'\n');
        Ok(json)
    }
}

/// SHA-256 in hexadecimal.
pub(super) fn sha256(bytes: &[u8]) -> String {
    HEXLOWER.encode(&Sha256::digest(bytes))
}

/// A file of results: a regular file only, since a pipe may never end.
///
/// # Errors
/// If it cannot be read.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    regular(path, TUNING.largest_file)
}

/// Whether a name is of a file or folder in the folder itself.
pub(super) fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|plain| plain == name)
}
