//! A program instead of a mechanism.

use std::path::PathBuf;

use mbint_fmu::Task;

use crate::grammar::display_unit::DisplayUnit;

/// A program that is given points and answers with rows.
#[derive(Clone, Debug, PartialEq)]
pub struct BlackBox {
    /// Location in the model file, for people: `box.yaml:4`.
    pub place: String,
    /// Program that computes the outputs.
    pub program: Program,
    /// Its outputs.
    pub outputs: Vec<BoxOutput>,
    /// How points and rows are written.
    pub protocol: Protocol,
    /// Whether a process stays for further calls.
    pub persistent: bool,
    /// Largest number of processes at once; `None` for the number of threads.
    pub processes: Option<usize>,
    /// Largest number of points of a call; `None` for all.
    pub points: Option<usize>,
    /// Time that a point may take, s.
    pub time_limit: Option<f64>,
    /// How often a point that failed is tried again.
    pub retries: usize,
    /// How the error of its own steps is found, if that is given.
    pub refine: Option<Refine>,
}

/// Program that replaces a mechanism.
#[derive(Clone, Debug, PartialEq)]
pub enum Program {
    /// A program.
    Command {
        /// The program, then its arguments.
        words: Vec<String>,
        /// The folder in which it works; `None` for that of mbint.
        directory: Option<PathBuf>,
    },
    /// A unit of FMI, in a process of mbint.
    Fmu(FmuProgram),
}

/// A unit of FMI, and its variables that are set and wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuProgram {
    /// Its file.
    pub file: PathBuf,
    /// Its variables.
    pub task: Task,
    /// Length of its steps, s, as far as the model says it.
    pub step: Option<f64>,
}

impl BlackBox {
    /// The program as people see it: its command, or the unit's file.
    pub fn words(&self) -> Vec<String> {
        match &self.program {
            Program::Command { words, .. } => words.clone(),
            Program::Fmu(own) => vec![own.file.display().to_string()],
        }
    }

    /// The unit that answers, if one does.
    pub fn fmu(&self) -> Option<&FmuProgram> {
        match &self.program {
            Program::Command { .. } => None,
            Program::Fmu(own) => Some(own),
        }
    }
}

/// An output of a black box.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxOutput {
    /// Its name, in the protocol and in formulas.
    pub name: String,
    /// Unit of its numbers; those of a unit of FMI are in SI, and shown in it.
    pub unit: DisplayUnit,
}

/// How points and rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// A JSON object a line.
    Json,
    /// Tables.
    Csv,
}

/// A parameter that decides the error of a black box's steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refine {
    /// Its index among all parameters; it is not uncertain.
    pub parameter: usize,
    /// Factor for finer steps.
    pub by: f64,
}
