//! A program in place of a mechanism.

use std::path::PathBuf;

use crate::grammar::display_unit::DisplayUnit;

/// A program that is given points and answers with rows.
#[derive(Clone, Debug, PartialEq)]
pub struct BlackBox {
    /// Place in the model file, for people: `box.yaml:4`.
    pub place: String,
    /// The program, then its arguments.
    pub command: Vec<String>,
    /// The folder in which it works; that of mbint where it is absent.
    pub directory: Option<PathBuf>,
    /// Its outputs.
    pub outputs: Vec<BoxOutput>,
    /// How points and rows are written.
    pub protocol: Protocol,
    /// Whether a process stays for further calls.
    pub persistent: bool,
    /// Processes at once, at most; as many as threads where it is absent.
    pub processes: Option<usize>,
    /// Points of a call, at most; all where it is absent.
    pub points: Option<usize>,
    /// Time that a point may take, s.
    pub time_limit: Option<f64>,
    /// How often a point that failed is tried again.
    pub retries: usize,
    /// How the error of its own steps is found, where that is said.
    pub refine: Option<Refine>,
}

/// An output of a black box.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxOutput {
    /// Its name, in the protocol and in formulas.
    pub name: String,
    /// Unit of its numbers.
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
