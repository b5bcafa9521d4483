//! The header of a model's code.

use super::Code;
use crate::compile::Tapes;

/// Text of the header.
pub(super) fn header(code: &Code) -> String {
    let Code { simulator, schedule, prefix, outputs, .. } = code;
    let guard = format!("{}_H", prefix.to_uppercase());
    let solver = if code.has_solver() {
        format!("\n    double solver[{}];", simulator.start.registers().max(1))
    } else {
        String::new()
    };
    let unknowns = simulator.program.layout.w.len() + simulator.program.layout.lambda.len() + 1;
    let names: Vec<String> =
        outputs.iter().map(|(name, unit)| format!("{name} [{unit}]").replace("*/", "* /")).collect();
    let parameters = if code.parameters > 0 { of_parameters(code) } else { String::new() };
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
{parameters}
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

/// Functions of a model whose parameters may have other values.
fn of_parameters(code: &Code) -> String {
    let prefix = code.prefix;
    format!(
        "
/* Uncertain parameters: names, SI units, and nominal values. */
enum {{ {prefix}_parameter_count = {} }};
extern const char *const {prefix}_parameter_names[];
extern const char *const {prefix}_parameter_units[];
extern const double {prefix}_parameter_values[];

/* At the start of other values of the parameters. Returns 0, or 1 where it cannot be assembled. */
int {prefix}_start_at({prefix}_model *model, const double *parameters);

/* Changes a parameter during the motion: one of forces, on which neither constraints nor masses depend. */
void {prefix}_set({prefix}_model *model, int parameter, double value);
",
        code.parameters
    )
}
