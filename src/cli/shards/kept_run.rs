//! A run whose simulations are kept in a folder.

use std::cell::RefCell;
use std::path::PathBuf;

use crate::cli::console::count;
use crate::cli::job::{Job, Request};
use crate::store::{Missing, PartStore, Shard, StoreError};

/// Where a run's simulations are kept, and what it left to shards.
#[derive(Debug)]
pub(in crate::cli) struct KeptRun {
    folder: PathBuf,
    missing: Missing,
    /// Whether nothing is written but the plan.
    plans: bool,
    shards: RefCell<Vec<Shard>>,
}

impl KeptRun {
    /// In a folder.
    pub fn new(folder: PathBuf, missing: Missing) -> Self {
        Self { folder, missing, plans: false, shards: RefCell::default() }
    }

    /// In a folder, without results.
    pub fn planning(folder: PathBuf, missing: Missing) -> Self {
        Self { plans: true, ..Self::new(folder, missing) }
    }

    /// The store of a job.
    pub fn open(&self, job: &Job, request: &Request) -> Result<PartStore, StoreError> {
        let asked = request.asked();
        let context = super::context(&job.files, &asked.set, job.scene.as_deref(), asked.skip_infeasible);
        PartStore::open(&self.folder, &context, self.missing)
    }

    /// Notes what a job left to shards. Whether its results are complete and to be written.
    pub fn close(&self, job: &Job, store: &PartStore) -> bool {
        let deferred = store.deferred();
        self.shards.borrow_mut().extend(Shard::of(job.number, job.scene.as_deref(), &deferred));
        deferred.is_empty() && !self.plans
    }

    /// What was taken from the folder, and what was added.
    pub fn told(&self, store: &PartStore) -> String {
        let (found, simulated) = store.counts();
        let found = count(found - simulated.min(found), "part", "parts");
        format!("{found} from {}, {} simulated", self.folder.display(), count(simulated, "part", "parts"))
    }

    /// All that was left.
    pub fn shards(self) -> Vec<Shard> {
        self.shards.into_inner()
    }
}
