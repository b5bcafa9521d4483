//! The simulations of a shard.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::FORMAT;
use super::error::StoreError;
use super::whole::{self, Durable};
use crate::methods::{Observed, Until};
use crate::numerics::Sample;
use crate::simulate::{Channel, Controller, Schedule};

/// Samples that are simulated together, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Number of the subsystem.
    pub subsystem: usize,
    /// Steps of all samples.
    pub schedule: Schedule,
    /// Tolerance of the steps' local errors, if they are controlled.
    pub tolerance: Option<Controller>,
    /// Values stored in each row.
    pub observed: Observed,
    /// When to end.
    pub until: Until,
    /// Reductions of outputs to one number.
    pub channels: Vec<Channel>,
    /// Set for samples of a scan: its bounds are stored instead of values.
    pub scan: Option<ScanPart>,
    /// Parameters of each sample.
    pub samples: Vec<Sample>,
}

/// Consecutive samples of a scan's grid.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScanPart {
    /// Points along each axis of the whole grid.
    pub points: Vec<usize>,
    /// Number of the first sample.
    pub first: usize,
}

impl Task {
    /// Bytes that are equal for equal tasks.
    pub(super) fn to_bytes(&self) -> Result<Vec<u8>, StoreError> {
        Ok(postcard::to_stdvec(&(FORMAT, self))?)
    }

    pub(super) fn write(&self, path: &Path) -> Result<(), StoreError> {
        // One that is lost is planned again.
        whole::write(path, &self.to_bytes()?, Durable::Soon)
    }

    pub(super) fn read(path: &Path) -> Result<Self, StoreError> {
        let bytes = std::fs::read(path).map_err(|error| StoreError::io(path, error))?;
        match postcard::from_bytes::<(u32, Self)>(&bytes) {
            Ok((FORMAT, task)) => Ok(task),
            _ => Err(StoreError::damaged(path)),
        }
    }
}
