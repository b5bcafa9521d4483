//! The header of a model's code.

use super::{Code, NOTICE};
use crate::compile::Tapes;
use crate::simulate::explicit::WITH_DENSE;

/// Text of the header.
pub(super) fn header(code: &Code) -> String {
    let Code { schedule, prefix, outputs, method, .. } = code;
    let guard = format!("{}_H", prefix.to_uppercase());
    let names: Vec<String> =
        outputs.iter().map(|(name, unit)| format!("{name} [{unit}]").replace("*/", "* /")).collect();
    let parameters = if code.parameters > 0 { of_parameters(code) } else { String::new() };
    let by = match (method.is_explicit, method.controller, method.levels) {
        (true, ..) => "Dormand and Prince's explicit method of order 8",
        (_, Some(_), 1) => "HHT-I3 with steps by a tolerance",
        (_, Some(_), _) => "HHT-I3 with steps by a tolerance, extrapolated",
        (_, None, 1) => "fixed steps of HHT-I3",
        (..) => "fixed steps of HHT-I3, extrapolated",
    };
    let step = match method.is_explicit {
        true => "On to the time `end`, s, by the steps of the run: `h` and `refines` are not used.",
        false => "One step of h to the time `end`, s; with `refines`, accelerations are as accurate as positions.",
    };
    let memory = memory(code);
    format!(
        "/* The nominal motion of a mechanism, by {by}.
 *
 * {prefix}_start, then {prefix}_row for rows 1, 2, … in turn, and {prefix}_outputs whenever outputs are wanted:
 * {}.
 * No function allocates, and models are independent of each other.
 *
 * {NOTICE} */

#ifndef {guard}
#define {guard}

#ifdef __cplusplus
extern \"C\" {{
#endif

enum {{ {prefix}_output_count = {}, {prefix}_rows = {} }};

{memory}
/* Names and SI units of the outputs. */
extern const char *const {prefix}_output_names[];
extern const char *const {prefix}_output_units[];

/* At the nominal start, which is row 0. */
void {prefix}_start({prefix}_model *model);
{parameters}
/* On to a row, from the one before. Returns 0, or 1 where a step does not converge. */
int {prefix}_row({prefix}_model *model, int row);

/* {step} Returns as above. */
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
    )
}

/// Types of a motion's memory.
fn memory(code: &Code) -> String {
    let Code { simulator, prefix, method, .. } = code;
    let layout = &simulator.program.layout;
    let unknowns = layout.w.len() + layout.lambda.len() + 1;
    let solver = match method.has_solver {
        true => format!("    double solver[{}];\n", simulator.start.registers().max(1)),
        false => String::new(),
    };
    let closure = method
        .closure
        .map_or(String::new(), |closure| format!("    double closure[{}];\n", closure.registers().max(1)));
    let balance = method.equilibrium.map_or(String::new(), |equilibrium| {
        let unknowns = layout.q.len() + layout.lambda.len();
        let registers = equilibrium.program().registers().max(1);
        format!("    double balance[{registers}], matrix[{}];\n", unknowns * (unknowns + 1) + 1)
    });
    let solver = solver + &balance;
    if method.is_explicit {
        let size = 2 * layout.q.len() + 1;
        return format!(
            "/* The memory of one motion. */
typedef struct {{
{solver}{closure}    double state[{size}], next[{size}], motion[{size}], rates[{WITH_DENSE}][{size}], dense[7][{size}];
    double time, open, now;
    int steps;
}} {prefix}_model;
"
        );
    }
    let (errors, alone) = match method.controller {
        Some(_) => (
            "    double error, whole_error;\n",
            format!("    {prefix}_stepper alone;\n    double h;\n    int is_alone, has_switched;\n"),
        ),
        None => ("", String::new()),
    };
    let singular = if method.is_singular { "    int is_singular;\n" } else { "" };
    let switches =
        method.switches.map_or(String::new(), |own| format!("    double switches[{}];\n", own.registers().max(1)));
    format!(
        "/* A state with what its iteration knows of the steps before, and the memory of one motion. */
typedef struct {{
    double r[{}], now[{unknowns}], before[{unknowns}], before_that[{unknowns}];
    double step_size, prepared_size, size_before, contraction;
{errors}{singular}    int known;
    unsigned steps;
}} {prefix}_stepper;

typedef struct {{
    {prefix}_stepper shared;
{alone}}} {prefix}_level;

typedef struct {{
    {prefix}_level levels[{}];
{solver}{closure}{switches}}} {prefix}_model;
",
        simulator.program.registers().max(1),
        method.levels,
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
