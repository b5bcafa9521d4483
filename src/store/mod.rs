//! Simulations kept as files, so that a run can be cut into shards, interrupted, and resumed.
//!
//! What a method asks of an ensemble is a [`Task`]; what comes of it is a part, a file in the store whose name is a hash of all that decides
//! it. A run with a store simulates what is missing and reads the rest. While a study is planned or merged, what takes long is deferred
//! instead: tasks are written for `mbint shard`, and the study ends there. A part is cut where the number of rows and values says, never where
//! a shard ends, so no bit of the results depends on shards.

mod error;
mod part;
mod plan;
mod task;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use sha2::{Digest, Sha256};

pub use error::StoreError;
pub use part::{PartReader, PartWriter};
pub use plan::{Asked, AskedPoints, Plan, Shard, StudyFolder};
pub use task::{ScanPart, Task};

/// Version of the files of parts and tasks. Files of another version are not read.
pub const FORMAT: u32 = 1;

/// What is done where a part is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Missing {
    /// It is simulated, and kept.
    Simulate,
    /// What is expected to take longer, s, is deferred to shards.
    Defer(f64),
}

/// A task that was deferred.
#[derive(Clone, Debug, PartialEq)]
pub struct Deferred {
    /// Name of its part.
    pub part: String,
    /// Samples.
    pub simulations: usize,
    /// What it is expected to take, s.
    pub seconds: f64,
    /// Size of the part.
    pub bytes: u64,
}

/// Parts of one model's run in a folder.
#[derive(Debug)]
pub struct PartStore {
    folder: PathBuf,
    /// Hash of what all parts of the run depend on.
    context: [u8; 32],
    missing: Missing,
    deferred: Mutex<Vec<Deferred>>,
    found: AtomicUsize,
    simulated: AtomicUsize,
}

impl PartStore {
    /// Parts of a run in a folder, which is made where it does not exist. `context` is all that decides the results beside the tasks: the
    /// model's files, overrides and scene, in any unambiguous form.
    ///
    /// # Errors
    /// Where the folder cannot be made.
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
            deferred: Mutex::new(Vec::new()),
            found: AtomicUsize::new(0),
            simulated: AtomicUsize::new(0),
        })
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
    /// Where it is there and cannot be read.
    pub fn part(&self, name: &str) -> Result<Option<PartReader>, StoreError> {
        let part = PartReader::open(&self.path(PARTS, name, "part"))?;
        if part.is_some() {
            self.found.fetch_add(1, Ordering::Relaxed);
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
    /// Where the file cannot be made.
    pub fn begin(&self, name: &str) -> Result<PartWriter, StoreError> {
        self.simulated.fetch_add(1, Ordering::Relaxed);
        PartWriter::begin(&self.path(PARTS, name, "part"))
    }

    /// Whether a task of so many seconds is simulated here.
    pub fn simulates(&self, seconds: f64) -> bool {
        match self.missing {
            Missing::Simulate => true,
            Missing::Defer(most) => seconds <= most,
        }
    }

    /// Leaves a task to a shard.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn defer(&self, name: &str, task: &Task, seconds: f64, bytes: u64) -> Result<(), StoreError> {
        task.write(&self.path(TASKS, name, "task"))?;
        let deferred = Deferred { part: name.to_owned(), simulations: task.samples.len(), seconds, bytes };
        // A panic elsewhere leaves the list whole: it only grows.
        self.deferred.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(deferred);
        Ok(())
    }

    /// What was deferred, in the order of the study.
    pub fn deferred(&self) -> Vec<Deferred> {
        self.deferred.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }

    /// A task that was deferred.
    ///
    /// # Errors
    /// Where it is missing or damaged.
    pub fn task(&self, name: &str) -> Result<Task, StoreError> {
        Task::read(&self.path(TASKS, name, "task"))
    }

    /// Parts that were found, and parts that were simulated.
    pub fn counts(&self) -> (usize, usize) {
        (self.found.load(Ordering::Relaxed), self.simulated.load(Ordering::Relaxed))
    }

    fn path(&self, folder: &str, name: &str, extension: &str) -> PathBuf {
        self.folder.join(folder).join(format!("{name}.{extension}"))
    }
}

/// Folders of parts and of tasks in a store.
const PARTS: &str = "parts";
const TASKS: &str = "tasks";
