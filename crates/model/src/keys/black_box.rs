//! A program instead of a mechanism.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::grammar::mapping::schema_only;

schema_only! {
    #[schemars(rename_all = "lowercase", inline)]
    pub enum ProtocolName {
        /// JSON lines: a point on a line in, its rows on a line out. The default.
        Json,
        /// A table of points in, a table of rows out.
        Csv,
    }
}

schema_only! {
    #[schemars(rename_all = "snake_case", inline)]
    pub enum InterfaceName {
        /// The unit takes steps of its own.
        CoSimulation,
        /// The unit's equations are integrated by a method of fifth order with fixed steps.
        ModelExchange,
    }
}

grammar! {
    /// A program that is given points, values of the parameters, and answers with the rows of the outputs.
    BlackBoxFile is "`black_box`" {
        /// The program and its arguments, one by one: no shell reads them.
        command: Option<Vec<String>>,
        /// A unit of FMI 2.0 or 3.0, instead of a command: a file in the model's folder or below. It is native code,
        /// and running it is trusting it.
        fmu: Option<String>,
        /// How a unit advances in time; by default by co-simulation, if it supports that.
        interface: Option<InterfaceName>,
        /// Names of variables of the unit, by the names of parameters and outputs that stand for them here.
        variables: Option<IndexMap<String, String>>,
        /// The longest step, s, of model exchange (by default a tenth of `output_step`), and of the communication of
        /// co-simulation (by default `output_step`).
        step: Option<Number>,
        /// The outputs that it answers with, by name, each with the unit of its numbers; `1` of a number. Those of a
        /// unit are converted; by default they are all of its outputs.
        outputs: Option<IndexMap<String, UnitName>>,
        /// How points and rows are written; by default `json`.
        protocol: Option<ProtocolName>,
        /// Whether a process stays for further calls; by default it does with `json`, and cannot with `csv`.
        persistent: Option<bool>,
        /// The folder in which it works, relative to the model's; by default the one in which mbint was started.
        directory: Option<String>,
        /// Processes at once, at most; by default as many as threads.
        processes: Option<u32>,
        /// Points of a call, at most; by default 1 with `json`, and all with `csv`.
        points: Option<u32>,
        /// Time that a point may take, s; by default there is no limit.
        time_limit: Option<Number>,
        /// How often a point that failed is tried again; by default once.
        retries: Option<u32>,
        /// The parameter that decides the program's own time steps, by which their error is found.
        refine: Option<RefineFile>,
    }

    /// A parameter that decides the error of the program's own steps.
    RefineFile is "`refine`" {
        /// Its name: a parameter without a tolerance, such as the length of a step.
        parameter: String,
        /// The factor for finer steps: 0.5 halves a length, 2 doubles a number; the error is of second order or more.
        by: Number,
    }
}
