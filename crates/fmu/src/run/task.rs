//! The task of a process: variables of a unit to set and to read.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::unit::{Interface, NotRead, NumberType, unpack};

/// The name among parameters that carries the length of steps, s; no parameter can have it.
pub const STEP: &str = "length of a step";

/// File of the task in the folder of an unpacked unit.
const FILE: &str = "mbint-task.json";

/// A variable of the unit, and the conversion of its numbers to SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Access {
    /// Its name in points and answers.
    pub name: String,
    /// Its type.
    pub kind: NumberType,
    /// Its number in the unit.
    pub reference: u32,
    /// Value of its unit in SI.
    pub factor: f64,
    /// Value in SI of a zero in its unit.
    pub offset: f64,
}

impl Access {
    /// A value of the unit, in SI.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.factor + self.offset
    }

    /// A value in SI, in the variable's unit.
    pub fn of_si(&self, value: f64) -> f64 {
        (value - self.offset) / self.factor
    }
}

/// The task of a process.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Interface by which the unit moves on.
    pub interface: Interface,
    /// Variables that are set.
    pub parameters: Vec<Access>,
    /// Variables that are wanted.
    pub outputs: Vec<Access>,
}

/// A unit in a folder of its own, with its task; the folder is deleted when this is dropped.
#[derive(Debug)]
pub struct Unpacked(TempDir);

impl Unpacked {
    /// Unpacks a unit.
    ///
    /// # Errors
    /// If it cannot be read, or there is no folder for it.
    pub fn new(unit: &Path, task: &Task) -> Result<Self, NotRead> {
        let folder = tempfile::Builder::new().prefix("mbint-fmu-").tempdir()?;
        unpack(unit, folder.path())?;
        let text = serde_json::to_string(task).map_err(std::io::Error::from)?;
        fs::write(folder.path().join(FILE), text)?;
        Ok(Self(folder))
    }

    /// Its folder.
    pub fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Task {
    /// The task in the folder of an unpacked unit.
    ///
    /// # Errors
    /// If there is none.
    pub fn read(folder: &Path) -> std::io::Result<Self> {
        Ok(serde_json::from_str(&fs::read_to_string(folder.join(FILE))?)?)
    }
}
