//! A run that stores its simulations in a folder.

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
    /// Whether only the plan is written.
    plans: bool,
    /// Longest time of a shard, s.
    shard_seconds: f64,
    shards: RefCell<Vec<Shard>>,
    /// Contents of the folder when it was opened last.
    there: Cell<Content>,
}

impl KeptRun {
    /// A run that stores its simulations in a folder.
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

    /// A run in the folder of a study, which defers work to shards of at most `asked.shard_seconds` seconds.
    pub fn of_study(folder: PathBuf, asked: &StudyRequest) -> Self {
        Self { shard_seconds: asked.shard_seconds, ..Self::new(folder, Missing::Defer(asked.at_once)) }
    }

    /// The same run, without results.
    pub fn planning(self) -> Self {
        Self { plans: true, ..self }
    }

    /// The store of a job; `context` is everything in addition to the tasks that determines its results.
    pub fn open(&self, context: &[u8]) -> Result<PartStore, StoreError> {
        let store = PartStore::open(&self.folder, context, self.missing)?;
        self.there.set(store.tidy()?);
        Ok(store)
    }

    /// Contents of the folder when it was opened, in words.
    pub fn there(&self) -> String {
        let Content { parts, bytes } = self.there.get();
        format!("{} in {} ({})", count(parts, "part", "parts"), self.folder.display(), HumanBytes(bytes))
    }

    /// Adds the tasks that a job left to shards, with its model and its scene. Returns whether its results are complete
    /// and to be written.
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

    /// All deferred shards.
    pub fn shards(self) -> Vec<Shard> {
        self.shards.into_inner()
    }
}

/// Message of a run with a store before its first simulation.
pub(super) fn expected(name: &str, there: &str, bytes: u64) -> String {
    format!("{name}: {there}; this run's simulations take {} on the disk at most", HumanBytes(bytes))
}

/// Everything in addition to the tasks that determines a model's results, unambiguously.
pub(super) fn context(files: &[ModelFile], set: &[String], scene: Option<&str>, skip_infeasible: bool) -> Vec<u8> {
    format!("{files:?}{set:?}{scene:?}{skip_infeasible}").into_bytes()
}
