//! A run whose simulations are kept in a folder.

use std::cell::{Cell, RefCell};
use std::path::PathBuf;

use indicatif::HumanBytes;

use super::console::count;
use crate::results::ModelFile;
use crate::store::{Content, Missing, PartStore, Shard, StoreError, StudyRequest};

/// Store of a run's simulations, with the tasks it left to shards.
#[derive(Debug)]
pub(super) struct KeptRun {
    folder: PathBuf,
    missing: Missing,
    /// Whether nothing is written but the plan.
    plans: bool,
    /// How long a shard may take, s.
    shard_seconds: f64,
    shards: RefCell<Vec<Shard>>,
    /// What the folder had when it was opened last.
    there: Cell<Content>,
}

impl KeptRun {
    /// In a folder.
    pub fn new(folder: PathBuf, missing: Missing) -> Self {
        Self {
            folder,
            missing,
            plans: false,
            shard_seconds: f64::INFINITY,
            shards: RefCell::default(),
            there: Cell::default(),
        }
    }

    /// In the folder of a study, which defers work to shards of at most `asked.shard_seconds` seconds.
    pub fn of_study(folder: PathBuf, asked: &StudyRequest) -> Self {
        Self { shard_seconds: asked.shard_seconds, ..Self::new(folder, Missing::Defer(asked.at_once)) }
    }

    /// The same, without results.
    pub fn planning(self) -> Self {
        Self { plans: true, ..self }
    }

    /// The store of a job, given all that decides its results beside the tasks.
    pub fn open(&self, context: &[u8]) -> Result<PartStore, StoreError> {
        let store = PartStore::open(&self.folder, context, self.missing)?;
        self.there.set(store.tidy()?);
        Ok(store)
    }

    /// What the folder had when it was opened, in words.
    pub fn there(&self) -> String {
        let Content { parts, bytes } = self.there.get();
        format!("{} in {} ({})", count(parts, "part", "parts"), self.folder.display(), HumanBytes(bytes))
    }

    /// Notes what a job left to shards: of which model, and of which scene of it. Whether its results are complete and
    /// to be written.
    pub fn close(&self, model: usize, scene: Option<&str>, store: &PartStore) -> bool {
        let deferred = store.deferred();
        self.shards.borrow_mut().extend(Shard::of(model, scene, &deferred, self.shard_seconds));
        deferred.is_empty() && !self.plans
    }

    /// Simulations read from the folder and added to it.
    pub fn found(&self, store: &PartStore) -> String {
        let (found, simulated) = store.counts();
        let found = count(found, "part", "parts");
        format!("{found} from {}, {} simulated", self.folder.display(), count(simulated, "part", "parts"))
    }

    /// All that was left.
    pub fn shards(self) -> Vec<Shard> {
        self.shards.into_inner()
    }
}

/// What a run with a store says before its first simulation.
pub(super) fn expected(name: &str, there: &str, bytes: u64) -> String {
    format!("{name}: {there}; this run's simulations take {} on the disk at most", HumanBytes(bytes))
}

/// All that decides a model's results beside the tasks, unambiguously.
pub(super) fn context(files: &[ModelFile], set: &[String], scene: Option<&str>, skip_infeasible: bool) -> Vec<u8> {
    format!("{files:?}{set:?}{scene:?}{skip_infeasible}").into_bytes()
}
