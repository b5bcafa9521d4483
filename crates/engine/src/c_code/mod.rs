//! A compiled mechanism as C99: the programs of its steps, the nominal start, and Newton's iteration (`runtime.c`).
//!
//! The code repeats the nominal motion of a run with fixed steps of HHT-I3. It has no rank-revealing solve: a
//! step in a singular configuration fails.

mod data;
mod fmi;

use std::fmt::Write;

use symdiff::CWriter;

use crate::compile::Tapes;
use crate::numerics::Sample;
use crate::simulate::{Integration, Schedule, SimulationError, Simulator};

/// The iteration, with names of the model's parts as macros.
const RUNTIME: &str = include_str!("runtime.c");

/// A model as C: its files by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CModel {
    /// Names and texts: a header, the model, and an example that writes its outputs as a table.
    pub files: Vec<(String, String)>,
    /// The same of a unit of FMI 3.0 for co-simulation, by paths in it, without a library.
    pub unit: Vec<(String, String)>,
    /// Name of the unit and of its library: one of C.
    pub identifier: String,
}

/// Why a model is not written as C.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCode {
    /// The runtime lacks something that the model needs.
    #[error("it cannot be written as C: {0}")]
    NotWritten(&'static str),
    /// It has no start.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Writes a mechanism under a schedule; `name` is that of the files and, where it is no name of C, of the functions
/// with underscores.
///
/// # Errors
/// Where it takes more than fixed steps of HHT-I3, and where the nominal sample has no start.
pub fn c_code(simulator: &Simulator, schedule: &Schedule, name: &str) -> Result<CModel, NoCode> {
    let system = &simulator.system;
    let refused = [
        (system.analysis.visits(), "its analysis is not a motion"),
        (schedule.integration != Integration::Plain, "its steps are combined, explicit or cut at events"),
        (!system.sampled.is_empty(), "states change at instants"),
    ];
    if let Some((_, why)) = refused.into_iter().find(|(is_so, _)| *is_so) {
        return Err(NoCode::NotWritten(why));
    }
    let nominal: Sample = system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let start = simulator.assemble(1, schedule.first_step(), |_| nominal.clone())?;
    let prefix: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let prefix = if prefix.starts_with(|c: char| c.is_ascii_digit()) { format!("m_{prefix}") } else { prefix };
    let outputs: Vec<(&str, &str)> =
        system.outputs.iter().map(|output| (output.name.as_str(), output.unit.as_str())).collect();
    let solves = !system.lambda.is_empty() && system.observes_accelerations();
    let header = header(simulator, schedule, &prefix, &outputs, solves);
    let mut writer = CWriter::default();
    let functions = functions(simulator, solves, &mut writer);
    let mut text = format!("/* {name}: written by mbint. Licence: that of the model. */\n\n");
    let _ = write!(
        text,
        "#include \"{name}.h\"\n\n#include <math.h>\n#include <string.h>\n\n{}\n",
        data::macros(simulator, schedule, &prefix, solves)
    );
    text += &writer.helpers();
    text += &data::tables(simulator, schedule, &start, &prefix, &outputs, solves);
    text += &functions;
    text += RUNTIME;
    let example = EXAMPLE.replace("NAME", name).replace("PREFIX", &prefix);
    let code = vec![(format!("{name}.h"), header), (format!("{name}.c"), text)];
    let unit = fmi::files(&fmi::Unit { name, prefix: &prefix, outputs: &outputs, schedule }, &code);
    let files = code.into_iter().chain([(format!("{name}_main.c"), example)]).collect();
    Ok(CModel { files, unit, identifier: prefix })
}

/// The tapes as functions of the memory.
fn functions(simulator: &Simulator, solves: bool, writer: &mut CWriter) -> String {
    let program = &simulator.program;
    let mut tapes = vec![
        ("sample", program.sample()),
        ("step_size", program.step_size()),
        ("step", program.step()),
        ("factor", program.factor()),
        ("first_correction", program.first_correction()),
        ("correct", program.correct()),
        ("advance", program.advance()),
        ("observe", program.observe()),
    ];
    if solves {
        tapes.extend([
            ("solver_sample", simulator.start.sample()),
            ("solver_acceleration", simulator.start.acceleration()),
        ]);
    }
    let mut text = String::new();
    for (name, tape) in tapes {
        let _ = write!(text, "static void {name}(double *r)\n{{\n{}    (void)r;\n}}\n\n", writer.statements(tape));
    }
    text
}

fn header(simulator: &Simulator, schedule: &Schedule, prefix: &str, outputs: &[(&str, &str)], solves: bool) -> String {
    let guard = format!("{}_H", prefix.to_uppercase());
    let solver =
        if solves { format!("\n    double solver[{}];", simulator.start.registers().max(1)) } else { String::new() };
    let unknowns = simulator.program.layout.w.len() + simulator.program.layout.lambda.len() + 1;
    let names: Vec<String> =
        outputs.iter().map(|(name, unit)| format!("{name} [{unit}]").replace("*/", "* /")).collect();
    format!(
        "/* The nominal motion of a mechanism, by fixed steps of HHT-I3.
 *
 * {prefix}_start, then {prefix}_row for rows 1, 2, … in turn, and {prefix}_outputs whenever outputs are wanted:
 * {}.
 * No function allocates, and models are independent of each other. */

#ifndef {guard}
#define {guard}

#ifdef __cplusplus
extern \"C\" {{
#endif

enum {{ {prefix}_output_count = {}, {prefix}_rows = {} }};

/* The memory of one motion. */
typedef struct {{
    double r[{}];{solver}
    double now[{unknowns}], before[{unknowns}], before_that[{unknowns}];
    double step_size, prepared_size, size_before, contraction;
    int known;
    unsigned steps;
}} {prefix}_model;

/* Names and SI units of the outputs. */
extern const char *const {prefix}_output_names[];
extern const char *const {prefix}_output_units[];

/* At the nominal start, which is row 0. */
void {prefix}_start({prefix}_model *model);

/* On to a row, from the one before. Returns 0, or 1 where a step does not converge. */
int {prefix}_row({prefix}_model *model, int row);

/* One step of h to the time `end`, s; with `refines`, accelerations are as accurate as positions. Returns as above. */
int {prefix}_step({prefix}_model *model, double h, double end, int refines);

/* Time of a row, s. */
double {prefix}_time(int row);

/* Outputs of the state, SI. */
void {prefix}_outputs({prefix}_model *model, double *outputs);

#ifdef __cplusplus
}}
#endif

#endif
",
        names.join(", "),
        outputs.len(),
        schedule.rows,
        simulator.program.registers(),
    )
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
