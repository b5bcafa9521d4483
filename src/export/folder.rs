//! Files put into a folder together: each whole, and none unless all could be written.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::files::ExportError;

/// Files that are written under temporary names beside their places, and get their own when all are there. So neither
/// a failure nor a killed run leaves half a file, or half a new file in place of an old one; a disk that is full leaves
/// the older results as they were; and of two runs into one folder one's files are there in the end, not some of each.
pub(super) struct Together<'d> {
    dir: &'d Path,
    files: Vec<(PathBuf, NamedTempFile)>,
}

impl<'d> Together<'d> {
    /// None yet, for a folder that is made if it is not there.
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
    /// If it cannot be written; temporary files go with `self`.
    pub fn add(&mut self, name: &str, contents: &[u8]) -> Result<(), ExportError> {
        let path = self.dir.join(name);
        let written = temporary(self.dir).and_then(|mut file| file.as_file_mut().write_all(contents).map(|()| file));
        let file = written.map_err(|source| ExportError::Write { path: path.clone(), source })?;
        self.files.push((path, file));
        Ok(())
    }

    /// Gives the files their names, in the order in which they were added. Where a folder can be locked, no other run does
    /// so at the same time.
    ///
    /// # Errors
    /// At the first that cannot be named so; those before it are kept.
    pub fn put_in_place(self) -> Result<Vec<PathBuf>, ExportError> {
        // Not every system opens folders, not every file system locks: without, two runs may mix.
        let folder = fs::File::open(self.dir).ok();
        let _ = folder.as_ref().map(fs::File::lock);
        let put = |(path, file): (PathBuf, NamedTempFile)| match file.persist(&path) {
            Ok(_) => Ok(path),
            Err(error) => Err(ExportError::Write { path, source: plain(error.error) }),
        };
        self.files.into_iter().map(put).collect()
    }
}

/// Makes `dir` if it is not there, and tries whether a file can be made in it: better known before a long run than after.
///
/// # Errors
/// If it cannot.
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

/// An empty file of a name that no other has, gone when dropped.
fn temporary(dir: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".mbint-").suffix(".tmp");
    // Temporary files are private; results are to be as readable as the user's other files (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(dir).map_err(plain)
}

/// tempfile adds the temporary path to its errors, which tells the user nothing: only what went wrong is left.
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
        let mut files = Together::in_folder(dir.path()).unwrap();
        files.add("a.csv", b"new").unwrap();
        assert_eq!(contents(), "old");
        drop(files);
        assert_eq!((contents().as_str(), fs::read_dir(dir.path()).unwrap().count()), ("old", 1), "no temporary files");
        let mut files = Together::in_folder(dir.path()).unwrap();
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
        let mut files = Together::in_folder(dir.path()).unwrap();
        files.add("ours", b"").unwrap();
        files.put_in_place().unwrap();
        let mode = |name| fs::metadata(dir.path().join(name)).unwrap().mode();
        assert_eq!(mode("ours"), mode("plain"));
    }
}
