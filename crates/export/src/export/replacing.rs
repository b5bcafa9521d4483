//! Replacement of files together: at any instant a folder has older files or newer ones, never a mixture.
//!
//! The new results are complete in a folder of its own before anything changes, and this folder then takes the name
//! [`JOURNAL`]: from here on the replacement is decided. Older files are set aside in the journal, first the file that
//! reports their completeness; then the new ones take their names, in their order. The next run that finds a journal
//! completes the rest of it ([`finish`]). If an older file cannot be set aside, all are restored.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use super::error::ExportError;
use super::owned::{SCENES, SUMMARY, read};

/// A replacement that was decided, in the folder whose files are replaced.
const JOURNAL: &str = ".mbint-replacing";

/// In the journal: the new files under their names, the older ones under numbers, and the work to be done.
const NEW: &str = "new";
const OLD: &str = "old";
const PLAN: &str = "plan.json";

/// Paths within the folder.
#[derive(Default, Serialize, Deserialize)]
struct Plan {
    /// The new files, in the order in which they appear.
    new: Vec<String>,
    /// Files that are removed.
    gone: Vec<String>,
}

/// New files that are not yet under their names.
pub(super) struct Replacement {
    folder: TempDir,
    plan: Plan,
}

impl Replacement {
    /// An empty set of files, in a folder that is empty and on the destination's disk.
    pub fn in_folder(folder: TempDir) -> io::Result<Self> {
        [NEW, OLD].iter().try_for_each(|name| fs::create_dir(folder.path().join(name)))?;
        Ok(Self { folder, plan: Plan::default() })
    }

    /// Writes a file to the disk.
    pub fn add(&mut self, name: &str, contents: &[u8]) -> io::Result<()> {
        self.write(&Path::new(NEW).join(name), contents)?;
        self.plan.new.push(name.to_owned());
        Ok(())
    }

    pub fn names(&self) -> &[String] {
        &self.plan.new
    }

    /// Files that are removed.
    pub fn without(&mut self, gone: Vec<String>) {
        self.plan.gone = gone;
    }

    /// Decides the replacement in a folder.
    ///
    /// # Errors
    /// If a folder has the name of a file, or the disk is full. Nothing has changed then.
    pub fn begin(self, dir: &Path) -> Result<(), ExportError> {
        for path in self.plan.new.iter().map(|name| dir.join(name)) {
            if path.symlink_metadata().is_ok_and(|there| there.is_dir()) {
                return Err(ExportError::Write { path, source: ErrorKind::IsADirectory.into() });
            }
        }
        let failed = |source| ExportError::Folder { path: dir.to_owned(), source };
        self.write(Path::new(PLAN), &serde_json::to_vec(&self.plan)?).map_err(failed)?;
        for name in [NEW, OLD, "."] {
            sync(&self.folder.path().join(name));
        }
        fs::rename(self.folder.path(), dir.join(JOURNAL)).map_err(failed)?;
        // It has another name now, and is not deleted.
        let _ = self.folder.keep();
        sync(dir);
        Ok(())
    }

    fn write(&self, path: &Path, contents: &[u8]) -> io::Result<()> {
        let mut file = File::create_new(self.folder.path().join(path))?;
        file.write_all(contents)?;
        file.sync_all()
    }
}

/// Renaming of a file; without the file `from`, it was renamed already, or there was none.
#[derive(Debug)]
struct Step {
    from: PathBuf,
    to: PathBuf,
}

impl Step {
    fn run(&self) -> Result<(), ExportError> {
        match fs::rename(&self.from, &self.to) {
            Err(source) if self.from.symlink_metadata().is_ok() => {
                Err(ExportError::Write { path: self.from.clone(), source })
            }
            _ => Ok(()),
        }
    }

    fn back(&self) {
        // An existing file of that name is newer.
        if !self.from.exists() {
            let _ = fs::rename(&self.to, &self.from);
        }
    }
}

/// The remaining work in a folder: older files that are set aside, and new ones that take their names.
fn steps(dir: &Path, plan: &Plan) -> [Vec<Step>; 2] {
    let journal = dir.join(JOURNAL);
    let new = |name: &str| Step { from: journal.join(NEW).join(name), to: dir.join(name) };
    // A new file that has its name already is not an older file of that name.
    let waiting: Vec<(usize, &String)> =
        plan.new.iter().enumerate().filter(|(_, name)| new(name).from.exists()).collect();
    let gone = (plan.new.len()..).zip(&plan.gone);
    let mut older: Vec<(usize, &String)> = waiting.iter().rev().copied().chain(gone).collect();
    older.sort_by_key(|(_, name)| ![SUMMARY, SCENES].contains(&name.as_str()));
    let aside = |&(number, name): &(usize, &String)| Step {
        from: dir.join(name),
        to: journal.join(OLD).join(number.to_string()),
    };
    [older.iter().map(aside).collect(), waiting.iter().map(|(_, name)| new(name)).collect()]
}

/// Whether a path stays in the folder: a file of its own, or of a scene.
fn is_within(path: &str) -> bool {
    let parts: Vec<Component> = Path::new(path).components().collect();
    (1..=2).contains(&parts.len()) && parts.iter().all(|part| matches!(part, Component::Normal(_)))
}

/// Completes a replacement that was decided, if there is one.
///
/// # Errors
/// If an older file cannot be set aside: all are then restored. If a new one cannot take its name, the rest is left to
/// the next run.
pub(super) fn finish(dir: &Path) -> Result<(), ExportError> {
    let journal = dir.join(JOURNAL);
    let plan = match read(&journal.join(PLAN)) {
        Ok(plan) => plan,
        Err(error) if error.kind() == ErrorKind::NotFound => {
            // The rest of a completed replacement.
            let _ = fs::remove_dir_all(journal);
            return Ok(());
        }
        Err(source) => return Err(ExportError::Read { path: journal.join(PLAN), source }),
    };
    let mut plan: Plan = serde_json::from_slice(&plan)?;
    plan.new.retain(|name| is_within(name));
    plan.gone.retain(|name| is_within(name));
    let [aside, index] = steps(dir, &plan);
    for (done, step) in aside.iter().enumerate() {
        if let Err(error) = step.run() {
            aside[..done].iter().rev().for_each(Step::back);
            remove(&journal);
            return Err(error);
        }
    }
    index.iter().try_for_each(Step::run)?;
    sync(dir);
    // The folder of a scene that has no files any more.
    for folder in plan.gone.iter().filter_map(|name| Path::new(name).parent()).filter(|path| *path != Path::new("")) {
        let _ = fs::remove_dir(dir.join(folder));
    }
    remove(&journal);
    Ok(())
}

/// Removes a journal; a rest that cannot be removed does no harm.
fn remove(journal: &Path) {
    // Without its plan it is not a journal.
    let _ = fs::remove_file(journal.join(PLAN));
    let _ = fs::remove_dir_all(journal);
}

/// Flushes a folder to the disk, if the system does that.
fn sync(folder: &Path) {
    let _ = File::open(folder).map(|folder| folder.sync_all());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with older files, whose replacement is decided.
    fn decided() -> TempDir {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("scene")).unwrap();
        for name in ["a.csv", "b.svg", "gone.svg", "scene/a.csv", SUMMARY, SCENES] {
            fs::write(dir.path().join(name), "old").unwrap();
        }
        let mut new = Replacement::in_folder(tempfile::tempdir_in(dir.path()).unwrap()).unwrap();
        for name in ["a.csv", "b.svg", "c.svg", SUMMARY] {
            new.add(name, b"new").unwrap();
        }
        new.without(["gone.svg", "scene/a.csv", SCENES].map(str::to_owned).to_vec());
        new.begin(dir.path()).unwrap();
        dir
    }

    /// Names of older and of newer files.
    fn found(dir: &Path) -> [Vec<String>; 2] {
        let names = ["a.csv", "b.svg", "c.svg", "gone.svg", "scene/a.csv", SCENES, SUMMARY];
        ["old", "new"].map(|text| {
            let has = |name: &&str| fs::read_to_string(dir.join(name)).is_ok_and(|found| found == text);
            names.into_iter().filter(has).map(str::to_owned).collect()
        })
    }

    #[test]
    fn interrupted_replacement_is_completed_without_mixing() {
        let plan: Plan = {
            let dir = decided();
            serde_json::from_slice(&fs::read(dir.path().join(JOURNAL).join(PLAN)).unwrap()).unwrap()
        };
        let mut ends = 0;
        for end in 0.. {
            let dir = decided();
            let all: Vec<Step> = steps(dir.path(), &plan).into_iter().flatten().collect();
            if end > all.len() {
                break;
            }
            all[..end].iter().for_each(|step| step.run().unwrap());
            let [old, new] = found(dir.path());
            assert!(old.is_empty() || new.is_empty(), "{end}: {old:?}, {new:?}");
            // The summary exists only when all others do.
            let says = |names: &[String]| names.iter().any(|name| name == SUMMARY);
            assert!((!says(&old) || old.len() == 6) && (!says(&new) || new.len() == 4), "{end}: {old:?}, {new:?}");
            // Killed once more, while it removes the journal.
            finish(dir.path()).unwrap();
            fs::create_dir_all(dir.path().join(JOURNAL).join(OLD)).unwrap();
            finish(dir.path()).unwrap();
            assert_eq!(found(dir.path()), [vec![], ["a.csv", "b.svg", "c.svg", SUMMARY].map(str::to_owned).to_vec()]);
            let mut left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            left.sort();
            assert_eq!(left, ["a.csv", "b.svg", "c.svg", SUMMARY]);
            ends += 1;
        }
        assert_eq!(ends, 12);
    }

    #[test]
    fn all_files_are_restored_if_one_cannot_be_moved() {
        let dir = decided();
        // All others are set aside when the last cannot be.
        let plan: Plan = serde_json::from_slice(&fs::read(dir.path().join(JOURNAL).join(PLAN)).unwrap()).unwrap();
        let [aside, _] = steps(dir.path(), &plan);
        let last = aside.last().unwrap();
        fs::create_dir(&last.to).unwrap();
        let error = finish(dir.path()).unwrap_err();
        assert!(matches!(&error, ExportError::Write { path, .. } if *path == last.from), "{error}");
        assert_eq!(found(dir.path())[0].len(), 6);
        assert!(!dir.path().join(JOURNAL).exists());
        finish(dir.path()).unwrap();
        assert_eq!(found(dir.path())[1], [""; 0]);
    }

    #[test]
    fn plan_moves_no_file_outside_its_folder() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        fs::create_dir_all(out.join(JOURNAL).join(OLD)).unwrap();
        fs::write(dir.path().join("mine.txt"), "mine").unwrap();
        let path = dir.path().join("mine.txt");
        let plan = Plan {
            new: vec!["../mine.txt".to_owned()],
            gone: vec!["../mine.txt".to_owned(), path.display().to_string()],
        };
        fs::write(out.join(JOURNAL).join(PLAN), serde_json::to_vec(&plan).unwrap()).unwrap();
        finish(&out).unwrap();
        assert!(path.exists() && !out.join(JOURNAL).exists());
    }
}
