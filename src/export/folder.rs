//! Atomic files: a set of files that appears in a folder completely or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::error::ExportError;

/// Files that are written under temporary names next to their destinations and renamed when all are written. Neither a failure
/// nor a killed run leaves a partial file; a full disk leaves older results unchanged; and of two runs into one folder, the
/// files of one remain, not a mixture.
///
/// The folder is locked meanwhile: temporary files that are there already are those of a run that was killed, and are removed.
pub(super) struct AtomicFiles<'d> {
    dir: &'d Path,
    files: Vec<(PathBuf, NamedTempFile)>,
    /// Files of an older run that go when these are in place.
    older: Vec<PathBuf>,
    /// Not every system opens folders, and not every file system locks: then the files of two runs may mix.
    folder: Option<fs::File>,
}

/// How temporary files are called.
const TEMPORARY: (&str, &str) = (".mbint-", ".tmp");

impl<'d> AtomicFiles<'d> {
    /// An empty set, for a folder that is created if it does not exist.
    ///
    /// # Errors
    /// As [`prepare_folder`].
    pub fn in_folder(dir: &'d Path) -> Result<Self, ExportError> {
        prepare_folder(dir)?;
        let folder = fs::File::open(dir).ok();
        let locked = folder.as_ref().is_some_and(|folder| folder.lock().is_ok());
        if locked {
            remove_left_over(dir);
        }
        Ok(Self { dir, files: Vec::new(), older: Vec::new(), folder })
    }

    /// Writes a file under a temporary name.
    ///
    /// # Errors
    /// If it cannot be written; temporary files are deleted with `self`.
    pub fn add(&mut self, name: &str, contents: &[u8]) -> Result<(), ExportError> {
        let path = self.dir.join(name);
        let written = temporary(self.dir).and_then(|mut file| file.as_file_mut().write_all(contents).map(|()| file));
        let file = written.map_err(|source| ExportError::Write { path: path.clone(), source })?;
        self.files.push((path, file));
        Ok(())
    }

    /// The names of all files so far.
    pub fn names(&self) -> Vec<String> {
        let names = self.files.iter().filter_map(|(path, _)| path.file_name());
        names.map(|name| name.to_string_lossy().into_owned()).collect()
    }

    /// Removes these files of the folder when the others are in place. What is no plain name is left alone, and so is what these files
    /// replace.
    pub fn without(&mut self, names: impl IntoIterator<Item = String>) {
        let known = self.names();
        let plain = |name: &String| Path::new(name).file_name().is_some_and(|plain| plain == name.as_str());
        let gone = names.into_iter().filter(|name| plain(name) && !known.contains(name));
        self.older.extend(gone.map(|name| self.dir.join(name)));
    }

    /// Renames the files to their destinations, in the order in which they were added, when they are on the disk.
    ///
    /// # Errors
    /// At the first file that cannot be renamed; those before it are kept.
    pub fn put_in_place(self) -> Result<Vec<PathBuf>, ExportError> {
        let put = |(path, file): (PathBuf, NamedTempFile)| {
            let written = file.as_file().sync_all();
            match written.and_then(|()| file.persist(&path).map_err(|error| error.error)) {
                Ok(_) => Ok(path),
                Err(source) => Err(ExportError::Write { path, source: plain(source) }),
            }
        };
        let written = self.files.into_iter().map(put).collect::<Result<Vec<_>, _>>()?;
        // What cannot be removed is in nobody's way.
        self.older.iter().for_each(|path| drop(fs::remove_file(path)));
        // Not every system writes folders to the disk.
        let _ = self.folder.as_ref().map(fs::File::sync_all);
        Ok(written)
    }
}

/// Writes texts under their names into a folder, which is created if it does not exist. Returns their paths.
///
/// # Errors
/// At the first that cannot be written.
pub fn write_pages(dir: &Path, pages: &[(String, String)]) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    for (name, text) in pages {
        files.add(name, text.as_bytes())?;
    }
    files.put_in_place()
}

/// Creates `dir` if it does not exist, and tests whether a file can be created in it, before a long run rather than after it.
///
/// # Errors
/// If either fails.
pub fn prepare_folder(dir: &Path) -> Result<(), ExportError> {
    let folder = |source| ExportError::Folder { path: dir.to_owned(), source };
    if dir.exists() && !dir.is_dir() {
        // The system would say "File exists".
        return Err(folder(io::ErrorKind::NotADirectory.into()));
    }
    fs::create_dir_all(dir).map_err(folder)?;
    temporary(dir).map_err(folder)?;
    Ok(())
}

/// Removes temporary files of runs that were killed.
fn remove_left_over(dir: &Path) {
    let Ok(entries) = fs::read_dir(dir) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let left_over = name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1));
        if left_over {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// An empty file with a unique name, deleted when dropped.
fn temporary(dir: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    // Temporary files are private; results are to be as readable as the user's other files (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(dir).map_err(plain)
}

/// The error without the temporary path that tempfile adds to it.
fn plain(error: io::Error) -> io::Error {
    match error.kind() {
        _ if error.raw_os_error().is_some() => error,
        io::ErrorKind::Other => error,
        kind => kind.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_replaced_before_all_is_written() {
        let dir = tempfile::tempdir().unwrap();
        let contents = || fs::read_to_string(dir.path().join("a.csv")).unwrap();
        fs::write(dir.path().join("a.csv"), "old").unwrap();
        let mut files = AtomicFiles::in_folder(dir.path()).unwrap();
        files.add("a.csv", b"new").unwrap();
        assert_eq!(contents(), "old");
        drop(files);
        assert_eq!((contents().as_str(), fs::read_dir(dir.path()).unwrap().count()), ("old", 1), "no temporary files");
        let mut files = AtomicFiles::in_folder(dir.path()).unwrap();
        files.add("a.csv", b"new").unwrap();
        assert_eq!(files.put_in_place().unwrap(), [dir.path().join("a.csv")]);
        assert_eq!((contents().as_str(), fs::read_dir(dir.path()).unwrap().count()), ("new", 1));
    }

    #[test]
    fn what_killed_and_older_runs_left_goes() {
        let dir = tempfile::tempdir().unwrap();
        for name in [".mbint-x1.tmp", "mine.tmp", "old.svg", "a.csv"] {
            fs::write(dir.path().join(name), "").unwrap();
        }
        let mut files = AtomicFiles::in_folder(dir.path()).unwrap();
        files.add("a.csv", b"new").unwrap();
        files.without(["old.svg", "a.csv", "../elsewhere", "never.svg"].map(str::to_owned));
        assert!(dir.path().join("old.svg").exists());
        files.put_in_place().unwrap();
        let mut names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["a.csv", "mine.tmp"]);
    }

    #[cfg(unix)]
    #[test]
    fn results_are_as_readable_as_other_files() {
        use std::os::unix::fs::MetadataExt;
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("plain"), "").unwrap();
        let mut files = AtomicFiles::in_folder(dir.path()).unwrap();
        files.add("ours", b"").unwrap();
        files.put_in_place().unwrap();
        let mode = |name| fs::metadata(dir.path().join(name)).unwrap().mode();
        assert_eq!(mode("ours"), mode("plain"));
    }
}
