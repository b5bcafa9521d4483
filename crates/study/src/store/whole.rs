//! Files that appear under their names when they are whole.
//!
//! A file that is being written has a temporary name and is locked by who writes it. One that is not locked was left
//! by a program that was killed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use super::Content;
use super::error::StoreError;

/// Prefix of temporary names.
const TEMPORARY: &str = ".part-";

/// Whether a file shall survive a loss of power at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Durable {
    /// Its bytes are on the disk before it appears.
    Now,
    /// The system writes it when it likes to. Lost or partial files are made again.
    Soon,
}

/// An empty file of a folder, under a temporary name.
pub(super) fn begin(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    // Other users of a shared folder can read the file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
    loop {
        let file = builder.tempfile_in(folder)?;
        // Not every file system locks; left-over files stay there then.
        let _ = file.as_file().lock();
        // Between the two it may have been taken for one that was left over.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Gives a temporary file its name.
pub(super) fn persist(file: NamedTempFile, path: &Path, durable: Durable) -> io::Result<()> {
    if durable == Durable::Now {
        file.as_file().sync_all()?;
    }
    file.persist(path).map(drop).map_err(|error| error.error)
}

/// Writes a whole file.
pub(super) fn write(path: &Path, bytes: &[u8], durable: Durable) -> Result<(), StoreError> {
    // A path of the store lies in one of its folders.
    let folder = path.parent().unwrap_or(Path::new("."));
    let written = begin(folder).and_then(|mut file| {
        file.write_all(bytes)?;
        persist(file, path, durable)
    });
    written.map_err(|error| StoreError::io(path, error))
}

/// Removes files left by programs that were killed while they wrote. Returns the rest of the content.
///
/// # Errors
/// If the folder cannot be read.
pub(super) fn remove_left_over(folder: &Path) -> Result<Content, StoreError> {
    let failed = |error| StoreError::io(folder, error);
    let mut content = Content::default();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if !entry.file_name().as_encoded_bytes().starts_with(TEMPORARY.as_bytes()) {
            content.parts += 1;
            content.bytes += entry.metadata().map_or(0, |about| about.len());
            continue;
        }
        // Whoever else removes it, or ends it, is faster.
        let Ok(file) = File::open(entry.path()) else { continue };
        if file.try_lock().is_ok() {
            let _ = fs::remove_file(entry.path());
        }
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_abandoned_temporary_files_are_removed() {
        let dir = tempfile::tempdir().unwrap();
        let names = || {
            let mut names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            names.sort();
            names
        };
        fs::write(dir.path().join(".part-dead"), "half").unwrap();
        fs::write(dir.path().join("whole.part"), "").unwrap();
        let mut living = begin(dir.path()).unwrap();
        assert_eq!(remove_left_over(dir.path()).unwrap(), Content { parts: 1, bytes: 0 });
        assert_eq!(names().len(), 2, "{:?}", names());
        living.write_all(b"done").unwrap();
        persist(living, &dir.path().join("a.part"), Durable::Now).unwrap();
        assert_eq!(remove_left_over(dir.path()).unwrap(), Content { parts: 2, bytes: 4 });
        assert_eq!(names(), ["a.part", "whole.part"]);
        assert_eq!(fs::read(dir.path().join("a.part")).unwrap(), b"done");
    }
}
