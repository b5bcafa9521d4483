//! Simulations stored as files, so that a run can be cut into shards, interrupted, and resumed.
//!
//! A method's request to an ensemble is a [`Task`]; its result is a part, a file in the store whose name is a hash of
//! all that determines it. A run with a store simulates missing parts and reads the rest. While a study is planned or
//! merged, long tasks are deferred instead: tasks are written for `mbint shard`, and the study ends there. A part is
//! cut where the number of rows and values says, never where a shard ends, so no bit of the results depends on shards.

mod error;
mod part;
mod plan;
mod task;
pub(crate) mod tuning;
mod whole;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};

pub use error::{StoreError, without};
pub use part::{PartReader, PartWriter};
pub use plan::{AskedPoints, Plan, Shard, StudyFolder, StudyRequest};
pub use task::{ScanPart, Task};

/// Version of the files of parts and tasks. Files of another version are not read.
pub const FORMAT: u32 = 1;

/// Action if a part is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missing {
    /// It is simulated and stored.
    Simulate,
    /// Tasks expected to take longer than this, s, are deferred to shards.
    Defer(f64),
}

/// A task that was deferred.
#[derive(Clone, Debug, PartialEq)]
pub struct Deferred {
    /// Name of its part.
    pub part: String,
    /// Samples.
    pub simulations: usize,
    /// Expected time, s.
    pub seconds: f64,
    /// Size of the part.
    pub bytes: u64,
}

/// Parts of one model's run in a folder.
#[derive(Debug)]
pub struct PartStore {
    folder: PathBuf,
    /// Hash of the inputs that all parts of the run depend on.
    context: [u8; 32],
    missing: Missing,
    deferred: Mutex<Vec<Deferred>>,
    /// Names of parts that were read, and of those that were begun.
    read: Mutex<HashSet<String>>,
    begun: Mutex<HashSet<String>>,
}

/// Number and size of the parts in a folder, of any run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Content {
    /// Number of parts.
    pub parts: usize,
    /// Their size.
    pub bytes: u64,
}

/// Value behind a lock. A panic elsewhere leaves it whole: it only grows.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl PartStore {
    /// Parts of a run in a folder, which is created if it does not exist. `context` is all that determines the results
    /// in addition to the tasks: the model's files, overrides and scene, in any unambiguous form.
    ///
    /// # Errors
    /// If the folder cannot be made.
    pub fn open(folder: &Path, context: &[u8], missing: Missing) -> Result<Self, StoreError> {
        for folder in [folder.join(PARTS), folder.join(TASKS)] {
            std::fs::create_dir_all(&folder).map_err(|error| StoreError::io(&folder, error))?;
        }
        let context = Sha256::new()
            .chain_update(FORMAT.to_le_bytes())
            .chain_update(env!("CARGO_PKG_VERSION"))
            .chain_update([0])
            .chain_update(context)
            .finalize()
            .into();
        Ok(Self {
            folder: folder.to_owned(),
            context,
            missing,
            deferred: Mutex::default(),
            read: Mutex::default(),
            begun: Mutex::default(),
        })
    }

    /// Content of the folder. Removes half-written files of programs that were killed. Shards do without this: they
    /// list nothing.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn tidy(&self) -> Result<Content, StoreError> {
        whole::remove_left_over(&self.folder.join(TASKS))?;
        whole::remove_left_over(&self.folder.join(PARTS))
    }

    /// Name of a task's part.
    ///
    /// # Errors
    /// Only if memory cannot be written to.
    pub fn name(&self, task: &Task) -> Result<String, StoreError> {
        let digest = Sha256::new().chain_update(self.context).chain_update(task.to_bytes()?).finalize();
        Ok(digest[..16].iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// A part that is there and whole. One that is damaged counts as missing.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    pub fn part(&self, name: &str) -> Result<Option<PartReader>, StoreError> {
        let part = PartReader::open(&self.path(PARTS, name, "part"))?;
        if part.is_some() {
            locked(&self.read).insert(name.to_owned());
        }
        Ok(part)
    }

    /// Whether a file of a part is there.
    pub fn has(&self, name: &str) -> bool {
        self.path(PARTS, name, "part").exists()
    }

    /// Begins a part.
    ///
    /// # Errors
    /// If the file cannot be made.
    pub fn begin(&self, name: &str) -> Result<PartWriter, StoreError> {
        locked(&self.begun).insert(name.to_owned());
        PartWriter::begin(&self.path(PARTS, name, "part"))
    }

    /// Whether a task of `seconds` seconds is simulated here.
    pub fn simulates(&self, seconds: f64) -> bool {
        match self.missing {
            Missing::Simulate => true,
            Missing::Defer(most) => seconds <= most,
        }
    }

    /// Leaves a task to a shard.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn defer(&self, name: &str, task: &Task, seconds: f64, bytes: u64) -> Result<(), StoreError> {
        task.write(&self.path(TASKS, name, "task"))?;
        let deferred = Deferred { part: name.to_owned(), simulations: task.samples.len(), seconds, bytes };
        locked(&self.deferred).push(deferred);
        Ok(())
    }

    /// Deferred tasks, in the order of the study.
    pub fn deferred(&self) -> Vec<Deferred> {
        locked(&self.deferred).clone()
    }

    /// A task that was deferred.
    ///
    /// # Errors
    /// If it is missing or damaged.
    pub fn task(&self, name: &str) -> Result<Task, StoreError> {
        Task::read(&self.path(TASKS, name, "task"))
    }

    /// Parts that were found, and parts that were simulated.
    pub fn counts(&self) -> (usize, usize) {
        let begun = locked(&self.begun);
        (locked(&self.read).difference(&begun).count(), begun.len())
    }

    fn path(&self, folder: &str, name: &str, extension: &str) -> PathBuf {
        self.folder.join(folder).join(format!("{name}.{extension}"))
    }
}

/// Folders of parts and of tasks in a store.
const PARTS: &str = "parts";
const TASKS: &str = "tasks";
