//! Atomic files: a set of files that appears in a folder completely or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::files::ExportError;

/// Files that are written under temporary names next to their destinations and renamed when all are written. Neither a failure
/// nor a killed run leaves a partial file; a full disk leaves older results unchanged; and of two runs into one folder, the
/// files of one remain, not a mixture.
pub(super) struct AtomicFiles<'d> {
    dir: &'d Path,
    files: Vec<(PathBuf, NamedTempFile)>,
}

impl<'d> AtomicFiles<'d> {
    /// An empty set, for a folder that is created if it does not exist.
    ///
    /// # Errors
    /// As [`prepare_folder`].
    pub fn in_folder(dir: &'d Path) -> Result<Self, ExportError> {
        prepare_folder(dir)?;
        Ok(Self { dir, files: Vec::new() })
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

    /// Renames the files to their destinations, in the order in which they were added. A lock on the folder, where there is one,
    /// keeps other runs from doing so at the same time.
    ///
    /// # Errors
    /// At the first file that cannot be renamed; those before it are kept.
    pub fn put_in_place(self) -> Result<Vec<PathBuf>, ExportError> {
        // Not every system opens folders, and not every file system locks: then the files of two runs may mix.
        let folder = fs::File::open(self.dir).ok();
        let _ = folder.as_ref().map(fs::File::lock);
        let put = |(path, file): (PathBuf, NamedTempFile)| match file.persist(&path) {
            Ok(_) => Ok(path),
            Err(error) => Err(ExportError::Write { path, source: plain(error.error) }),
        };
        self.files.into_iter().map(put).collect()
    }
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

/// An empty file with a unique name, deleted when dropped.
fn temporary(dir: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".mbint-").suffix(".tmp");
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
