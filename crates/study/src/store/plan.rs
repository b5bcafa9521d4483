//! `plan.json`: the simulations of a round of a study, cut into shards.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::StoreError;
use super::whole::{self, Durable};
use super::{Deferred, FORMAT, PARTS};

/// The file's name in the study's folder.
const PLAN: &str = "plan.json";

/// A study's round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of the format.
    pub format: u32,
    /// Version of mbint; another one makes other parts.
    pub mbint: String,
    /// Rounds planned so far; the next request of a study may depend on the results of the round before.
    pub round: usize,
    /// Request of the study.
    pub asked: StudyRequest,
    /// Simulations, by number of the shard.
    pub shards: Vec<Shard>,
}

/// Request of a study: the arguments of `mbint run` that decide results.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StudyRequest {
    /// Absolute paths of the models.
    pub models: Vec<PathBuf>,
    /// The models as they were named; results state that name, not the path on a machine.
    pub named: Vec<PathBuf>,
    /// Parameters that are set.
    pub set: Vec<String>,
    /// Absolute path of the folder whose files the models may name in addition to those of their own folders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub root: Option<PathBuf>,
    /// Scenes; all if empty.
    pub scenes: Vec<String>,
    /// Methods; the model's if empty.
    pub methods: Vec<String>,
    /// Whether certified bounds are added.
    pub certify: bool,
    /// Whether these are of the scheme.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub certify_scheme: bool,
    /// Whether every sample is simulated with halved steps too.
    pub certify_time: bool,
    /// Whether infeasible parameter values are omitted.
    pub skip_infeasible: bool,
    /// Tasks that take less are simulated when planning and merging, s.
    pub at_once: f64,
    /// Parts are joined to shards of at most this, s.
    pub shard_seconds: f64,
    /// Points of samples, if samples are requested in place of bounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<AskedPoints>,
}

/// Points of the requested samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AskedPoints {
    /// Absolute path of a table.
    Table(PathBuf),
    /// A design, as the command line names it.
    Design {
        /// `sobol:1000`.
        design: String,
        /// Seed of a Latin hypercube.
        seed: u64,
    },
}

/// The simulations of one call of `mbint shard`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shard {
    /// Number of the model among those asked for.
    pub model: usize,
    /// Name of its scene, if the model has scenes.
    pub scene: Option<String>,
    /// Names of the parts.
    pub parts: Vec<String>,
    /// Samples.
    pub simulations: usize,
    /// Expected time on one core, s.
    pub seconds: f64,
    /// Size of the parts.
    pub bytes: u64,
}

impl Shard {
    /// Shards of at most `seconds` seconds, unless a part takes longer, from the deferred tasks of a model.
    pub fn of(model: usize, scene: Option<&str>, deferred: &[Deferred], seconds: f64) -> Vec<Self> {
        let mut shards: Vec<Self> = Vec::new();
        for task in deferred {
            match shards.last_mut().filter(|shard| shard.seconds + task.seconds <= seconds) {
                Some(shard) => {
                    shard.parts.push(task.part.clone());
                    shard.simulations += task.simulations;
                    shard.seconds += task.seconds;
                    shard.bytes += task.bytes;
                }
                None => shards.push(Self {
                    model,
                    scene: scene.map(str::to_owned),
                    parts: vec![task.part.clone()],
                    simulations: task.simulations,
                    seconds: task.seconds,
                    bytes: task.bytes,
                }),
            }
        }
        shards
    }
}

/// The folder of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyFolder(PathBuf);

impl StudyFolder {
    /// At a path.
    pub fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.0
    }

    fn plan_file(&self) -> PathBuf {
        self.0.join(PLAN)
    }

    /// Reads the plan.
    ///
    /// # Errors
    /// If there is no plan, or it is of another version.
    pub fn plan(&self) -> Result<Plan, StoreError> {
        let path = self.plan_file();
        let bytes = std::fs::read(&path).map_err(|error| match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => {
                StoreError::NoStudy { folder: self.0.clone(), file: PLAN }
            }
            _ => StoreError::io(&path, error),
        })?;
        let plan = serde_json::from_slice::<Plan>(&bytes).ok();
        plan.filter(|plan| plan.format == FORMAT && plan.mbint == env!("CARGO_PKG_VERSION"))
            .ok_or_else(|| StoreError::damaged(&path))
    }

    /// Writes the plan of a round.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, round: usize, asked: StudyRequest, shards: Vec<Shard>) -> Result<(), StoreError> {
        std::fs::create_dir_all(&self.0).map_err(|error| StoreError::io(&self.0, error))?;
        let plan = Plan { format: FORMAT, mbint: env!("CARGO_PKG_VERSION").to_owned(), round, asked, shards };
        let mut text = serde_json::to_vec_pretty(&plan)
            .map_err(|error| StoreError::io(&self.plan_file(), std::io::Error::other(error)))?;
        text.push(b'\n');
        whole::remove_left_over(&self.0)?;
        whole::write(&self.plan_file(), &text, Durable::Now)
    }

    /// Numbers of shards of which a part is missing. Only names are examined.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn missing(&self, plan: &Plan) -> Result<Vec<usize>, StoreError> {
        let folder = self.0.join(PARTS);
        let entries = std::fs::read_dir(&folder).map_err(|error| StoreError::io(&folder, error))?;
        let mut there = std::collections::HashSet::new();
        for entry in entries {
            let entry = entry.map_err(|error| StoreError::io(&folder, error))?;
            there.insert(entry.file_name());
        }
        let is_there = |part: &String| there.contains(std::ffi::OsStr::new(&format!("{part}.part")));
        let lacks = |(number, shard): (usize, &Shard)| (!shard.parts.iter().all(is_there)).then_some(number);
        Ok(plan.shards.iter().enumerate().filter_map(lacks).collect())
    }
}
