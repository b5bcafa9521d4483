//! A compiled mechanism as C99: the programs of its steps, the nominal start, and the integration (`runtime`).
//!
//! The code repeats the nominal sample, by HHT-I3 under fixed steps or a tolerance, on one level or several, or by the
//! explicit method. A step in a singular configuration has a solve of its own where equations are few.

mod data;
mod fmi;
mod functions;
mod header;
mod inputs;
mod method;
mod tables;
pub mod tuning;

use std::fmt::Write;

use symdiff::CWriter;

use self::method::Method;
use crate::numerics::Sample;
use crate::simulate::{Observed, Schedule, SimulationError, Simulator, Steps, integrator};
use tuning::TUNING;

pub use fmi::FmiVersion;

/// Terms of the files, on one line.
const LICENCE: &str = "the model: its author's terms; the runtime, mbint's: MIT OR Apache-2.0";

/// The same at the head of files, with the expression that tools search for.
const NOTICE: &str =
    "The model, with its equations and numbers, is its author's, under the author's terms. The runtime beside it is
 * mbint's: it may be used, changed and passed on with the model, also where that is not open.
 * SPDX-License-Identifier: MIT OR Apache-2.0";

/// A model as C: its files by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CModel {
    /// Names and texts: a header, the model, and an example that writes its outputs as a table.
    pub files: Vec<(String, String)>,
    /// The same of a unit of FMI for co-simulation, by paths in it, without a library.
    pub unit: Vec<(String, String)>,
    /// Name of the unit and of its library: one of C.
    pub identifier: String,
    /// Steps of the nominal motion in singular configurations, if the code has no solve for these.
    pub singular_steps: u64,
}

/// Why a model is not written as C.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCode {
    /// The runtime lacks something that the model needs.
    #[error("it cannot be written as C: {0}")]
    NotWritten(&'static str),
    /// A parameter cannot be an input.
    #[error("`{name}` cannot be an input: {why}")]
    NoInput {
        /// Its name.
        name: String,
        /// The reason.
        why: String,
    },
    /// It has no start.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Options of a model's code.
#[derive(Clone, Copy, Debug)]
pub struct CodeRequest<'r> {
    /// Name of the files and, with underscores where C does not allow its letters, of the functions.
    pub name: &'r str,
    /// Parameters of forces that may change during the motion.
    pub inputs: &'r [String],
    /// Version of the unit.
    pub version: FmiVersion,
}

/// A model's code in the making: its sizes, and how it is integrated.
struct Code<'c> {
    simulator: &'c Simulator,
    schedule: &'c Schedule,
    /// Prefix of its functions.
    prefix: &'c str,
    /// Names and units of the outputs.
    outputs: &'c [(&'c str, &'c str)],
    method: Method<'c>,
    /// Number of parameters whose values may be changed at the start.
    parameters: usize,
}

impl Code<'_> {
    /// Whether all steps have one length.
    fn has_fixed_steps(&self) -> bool {
        self.schedule.steps_per_row().is_some()
    }
}

/// Writes a mechanism under the steps of a run.
///
/// # Errors
/// If the runtime lacks something that the analysis or the steps need, if the nominal sample has no start, and if a
/// parameter of `inputs` cannot be an input.
pub fn c_code(simulator: &Simulator, steps: Steps, request: CodeRequest) -> Result<CModel, NoCode> {
    let (system, schedule) = (&simulator.system, steps.schedule);
    let refused = [
        (system.analysis.visits(), "its analysis has no motion; without the key `analysis` it has one"),
        (schedule.integration.is_cut(), "its steps are cut at events that samples share; give `scheme: hht`"),
    ];
    if let Some((_, why)) = refused.into_iter().find(|(is_so, _)| *is_so) {
        return Err(NoCode::NotWritten(why));
    }
    let name = request.name;
    let nominal: Sample = system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let start = simulator.assemble(1, schedule.first_step(), |_| nominal.clone())?;
    let mut motion = integrator(simulator, &[nominal], schedule)?;
    let stops = motion.advance(steps, 0..schedule.rows, Observed::Coordinates, &mut Vec::new());
    if !stops.is_empty() {
        return Err(NoCode::NotWritten("its nominal motion stops before the end; `mbint run` says where and why"));
    }
    let prefix: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let prefix = if prefix.starts_with(|c: char| c.is_ascii_digit()) { format!("m_{prefix}") } else { prefix };
    let outputs: Vec<(&str, &str)> =
        system.outputs.iter().map(|output| (output.name.as_str(), output.unit.as_str())).collect();
    let unknowns = system.q.len() + system.lambda.len();
    let is_too_large = simulator.equilibrium.is_some() && unknowns > TUNING.most_balanced;
    let parameters = if is_too_large { &[][..] } else { &system.parameters[..] };
    let inputs = inputs::of(system, parameters, request.inputs)?;
    let method = Method::of(simulator, steps, parameters.len())?;
    let singular_steps = if method.is_singular { 0 } else { motion.counters().rank_revealing };
    let code = Code { simulator, schedule, prefix: &prefix, outputs: &outputs, method, parameters: parameters.len() };
    let mut writer = CWriter::default();
    let functions = functions::functions(&code, &mut writer);
    let mut text = format!("/* {name}: written by mbint.\n *\n * {NOTICE} */\n\n");
    let _ =
        write!(text, "#include \"{name}.h\"\n\n#include <math.h>\n#include <string.h>\n\n{}\n", data::macros(&code));
    text += &writer.helpers();
    text += &data::tables(&code, &start);
    text += &functions;
    text += &code.method.runtime();
    let example = EXAMPLE.replace("NAME", name).replace("PREFIX", &prefix);
    let files = vec![(format!("{name}.h"), header::header(&code)), (format!("{name}.c"), text)];
    let unit = fmi::Unit { name, prefix: &prefix, outputs: &outputs, parameters, inputs: &inputs, schedule };
    let unit = fmi::files(&unit, request.version, &files);
    let files = files.into_iter().chain([(format!("{name}_main.c"), example)]).collect();
    Ok(CModel { files, unit, identifier: prefix, singular_steps })
}

/// The example's source: a table of the outputs.
const EXAMPLE: &str = r#"/* Writes the nominal motion as a table: cc -std=c99 -O2 NAME.c NAME_main.c -lm */

#include "NAME.h"

#include <stdio.h>

static PREFIX_model model;

int main(void)
{
    double outputs[PREFIX_output_count + 1];
    int row, k;
    printf("t");
    for (k = 0; k < PREFIX_output_count; k++) printf(",%s", PREFIX_output_names[k]);
    printf("\n");
    PREFIX_start(&model);
    for (row = 0; row < PREFIX_rows; row++) {
        if (row > 0 && PREFIX_row(&model, row)) {
            fprintf(stderr, "a step before t = %g s does not converge\n", PREFIX_time(row));
            return 1;
        }
        PREFIX_outputs(&model, outputs);
        printf("%.17g", PREFIX_time(row));
        for (k = 0; k < PREFIX_output_count; k++) printf(",%.17g", outputs[k]);
        printf("\n");
    }
    return 0;
}
"#;
