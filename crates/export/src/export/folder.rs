//! Atomic files: a set of files that appears in a folder completely or not at all.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::error::ExportError;
use super::owned::{OWNED, Owned, sha256};
use super::replacing::{self, Replacement};
use super::tuning::TUNING;

/// Files that are written into a folder of their own within their destination, and replace older ones together when all
/// are written: neither a failure nor a killed run leaves a partial file; a full disk leaves older results unchanged;
/// and after two runs into one folder, the files of one remain, not a mixture. Only the file being written is open.
///
/// The folder is locked meanwhile: temporary files found in it belong to a run that was killed, and are removed.
pub(super) struct AtomicFiles<'d> {
    dir: &'d Path,
    replacement: Replacement,
    /// SHA-256 of the files, by name.
    hashes: BTreeMap<String, String>,
    /// The folder, opened and locked. Not every system opens folders, and not every file system locks: then the files
    /// of two runs may mix.
    folder: Option<fs::File>,
}

/// Prefix and suffix of temporary files.
const TEMPORARY: (&str, &str) = (".mbint-", ".tmp");

impl<'d> AtomicFiles<'d> {
    /// An empty set, for a folder that is created if it does not exist. Completes a replacement that a killed run
    /// began.
    ///
    /// # Errors
    /// As [`prepare_folder`], or if the files left there cannot be replaced.
    pub fn in_folder(dir: &'d Path) -> Result<Self, ExportError> {
        prepare_folder(dir)?;
        let folder = fs::File::open(dir).ok();
        let locked = folder.as_ref().is_some_and(|folder| folder.lock().is_ok());
        if locked {
            remove_left_over(dir);
        }
        replacing::finish(dir)?;
        let new = temporary().tempdir_in(dir).map_err(plain).and_then(Replacement::in_folder);
        let replacement = new.map_err(|source| ExportError::Folder { path: dir.to_owned(), source })?;
        Ok(Self { dir, replacement, hashes: BTreeMap::new(), folder })
    }

    /// Writes a file to the disk, not yet under its name.
    ///
    /// # Errors
    /// If it cannot be written; files already written are deleted with `self`.
    pub fn add(&mut self, name: &str, contents: &[u8]) -> Result<(), ExportError> {
        let written = self.replacement.add(name, contents);
        written.map_err(|source| ExportError::Write { path: self.dir.join(name), source: plain(source) })?;
        self.hashes.insert(name.to_owned(), sha256(contents));
        Ok(())
    }

    /// The names of all files so far.
    pub fn names(&self) -> Vec<String> {
        self.replacement.names().to_vec()
    }

    /// Makes these files, all of which are added, replace all other files that older runs wrote into the folder and its
    /// scenes' folders.
    ///
    /// # Errors
    /// If the list of our files cannot be written.
    pub fn replace_older(&mut self, scenes: Vec<String>) -> Result<(), ExportError> {
        let older = Owned::of(self.dir);
        let files = older.unchanged(self.dir).into_iter().filter(|name| !self.hashes.contains_key(name));
        let gone = older.scenes.iter().filter(|scene| !scenes.contains(scene));
        let of_scenes = gone.flat_map(|scene| {
            let folder = self.dir.join(scene);
            let own = Owned::of(&folder).unchanged(&folder).into_iter().chain([OWNED.to_owned()]);
            own.filter(|name| folder.join(name).exists()).map(|name| format!("{scene}/{name}")).collect::<Vec<_>>()
        });
        let gone = files.chain(of_scenes).collect();
        self.replacement.without(gone);
        self.list(Owned { files: self.hashes.clone(), scenes })
    }

    /// Adds these files, all of which are added, to the list of files that older runs wrote.
    ///
    /// # Errors
    /// If the list of our files cannot be written.
    pub fn join_older(&mut self) -> Result<(), ExportError> {
        let mut own = Owned::of(self.dir);
        own.files.extend(self.hashes.clone());
        self.list(own)
    }

    fn list(&mut self, own: Owned) -> Result<(), ExportError> {
        self.add(OWNED, &own.to_json()?)
    }

    /// Replaces older files by these, in the order in which they were added.
    ///
    /// # Errors
    /// At the first file that cannot be replaced; all are then restored.
    pub fn put_in_place(self) -> Result<Vec<PathBuf>, ExportError> {
        let names = self.names();
        self.replacement.begin(self.dir)?;
        replacing::finish(self.dir)?;
        // Not every system flushes folders to the disk.
        let _ = self.folder.as_ref().map(fs::File::sync_all);
        Ok(names.iter().filter(|name| *name != OWNED).map(|name| self.dir.join(name)).collect())
    }
}

/// Completes the replacement of a killed run: its files are all written, but not all have their names yet. Waits for a
/// run that writes now.
///
/// # Errors
/// If a file cannot be replaced.
pub(super) fn settle(dir: &Path) -> Result<(), ExportError> {
    let folder = fs::File::open(dir).ok();
    let _locked = folder.as_ref().is_some_and(|folder| folder.lock().is_ok());
    replacing::finish(dir)
}

/// Waits while another run writes into a folder; asks `waits` every tenth of a second whether to continue.
///
/// # Errors
/// If `waits` returns `false`.
pub fn wait_for_folder(dir: &Path, waits: &mut dyn FnMut() -> bool) -> Result<(), ExportError> {
    // A folder that cannot be opened or locked is not waited for.
    let Ok(folder) = fs::File::open(dir) else { return Ok(()) };
    while let Err(fs::TryLockError::WouldBlock) = folder.try_lock() {
        if !waits() {
            return Err(ExportError::Held { path: dir.to_owned() });
        }
        std::thread::sleep(TUNING.between_tries);
    }
    Ok(())
}

/// Writes texts under their names into a folder, which is created if it does not exist. Returns their paths.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_pages(dir: &Path, pages: &[(String, String)]) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    for (name, text) in pages {
        files.add(name, text.as_bytes())?;
    }
    files.put_in_place()
}

/// Creates `dir` if it does not exist, and tests whether a file can be created in it, before a long run rather than
/// after it.
///
/// # Errors
/// If either fails.
pub fn prepare_folder(dir: &Path) -> Result<(), ExportError> {
    let folder = |source| ExportError::Folder { path: dir.to_owned(), source };
    if dir.exists() && !dir.is_dir() {
        // The system's message would be "File exists".
        return Err(folder(io::ErrorKind::NotADirectory.into()));
    }
    fs::create_dir_all(dir).map_err(folder)?;
    temporary().tempfile_in(dir).map_err(|error| folder(plain(error)))?;
    Ok(())
}

/// Removes temporary files of runs that were killed.
fn remove_left_over(dir: &Path) {
    let Ok(entries) = fs::read_dir(dir) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let left_over = name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1));
        if left_over {
            let path = entry.path();
            let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }
}

/// Unique names, deleted when dropped.
fn temporary() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    builder
}

/// The error without the temporary path that tempfile adds to it, and without the kind's name if that carries no
/// information.
fn plain(error: io::Error) -> io::Error {
    let kind = error.kind();
    match error.to_string().split_once(" at path ") {
        Some((own, _)) if kind == io::ErrorKind::Other || kind.to_string() == "uncategorized error" => {
            io::Error::new(kind, own.to_owned())
        }
        Some(_) => kind.into(),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_replaced_only_after_all_are_written() {
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

    fn names(dir: &Path) -> Vec<String> {
        let entries = fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = entries.filter(|name| name != OWNED).collect();
        names.sort();
        names
    }

    fn replace(dir: &Path, files: &[(&str, &str)], scenes: &[&str]) {
        let mut set = AtomicFiles::in_folder(dir).unwrap();
        files.iter().for_each(|(name, text)| set.add(name, text.as_bytes()).unwrap());
        set.replace_older(scenes.iter().map(|&scene| scene.to_owned()).collect()).unwrap();
        set.put_in_place().unwrap();
    }

    #[test]
    fn only_files_of_killed_and_older_runs_are_removed() {
        let dir = tempfile::tempdir().unwrap();
        let dir = dir.path();
        for name in [".mbint-x1.tmp", "mine.tmp", "a.csv"] {
            fs::write(dir.join(name), "").unwrap();
        }
        fs::create_dir(dir.join(".mbint-x2.tmp")).unwrap();
        replace(dir, &[("a.csv", "1"), ("old.svg", "1"), ("edited.svg", "1"), ("gone.svg", "1")], &["one", "two"]);
        for scene in ["one", "two"] {
            replace(&dir.join(scene), &[("a.csv", "1")], &[]);
        }
        fs::write(dir.join("two/notes.txt"), "mine").unwrap();
        fs::write(dir.join("edited.svg"), "by hand").unwrap();
        fs::remove_file(dir.join("gone.svg")).unwrap();
        replace(dir, &[("a.csv", "2")], &["one"]);
        assert_eq!(names(dir), ["a.csv", "edited.svg", "mine.tmp", "one", "two"]);
        assert_eq!(
            (names(&dir.join("one")), names(&dir.join("two"))),
            (vec!["a.csv".into()], vec!["notes.txt".into()])
        );
        replace(dir, &[("a.csv", "3")], &[]);
        assert_eq!(names(dir), ["a.csv", "edited.svg", "mine.tmp", "two"]);
    }

    /// Such a list by others names files that mbint did not write, or paths elsewhere.
    #[test]
    fn foreign_list_of_files_removes_no_file() {
        let dir = tempfile::tempdir().unwrap();
        let (dir, out) = (dir.path(), dir.path().join("out"));
        fs::create_dir(&out).unwrap();
        fs::create_dir(out.join("scene")).unwrap();
        let mine = [dir.join("beside.txt"), out.join("notes.txt"), out.join("scene/notes.txt")];
        mine.iter().for_each(|path| fs::write(path, "mine").unwrap());
        let hash = sha256(b"mine");
        let list = format!(
            r#"{{"files": {{"notes.txt": "0", "../beside.txt": "{hash}", "scene/notes.txt": "{hash}"}}, "scenes": ["scene", "..", "."]}}"#
        );
        fs::write(out.join(OWNED), list).unwrap();
        for file in ["summary.json", "scenes.json"] {
            fs::write(out.join(file), r#"{"model": "m", "files": ["notes.txt"], "scenes": ["scene"]}"#).unwrap();
        }
        replace(&out, &[("a.csv", "1")], &[]);
        assert!(mine.iter().all(|path| path.exists()));
        assert_eq!(names(&out), ["a.csv", "notes.txt", "scene", "scenes.json", "summary.json"]);
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
