//! Numbers of a mechanism as C: sizes, tables, the nominal start and the schedule.

use std::fmt::Write;

use symdiff::{Tile, c_number};

use super::Code;
use super::tables::{constants, list, numbers, of_method, registers, structs};
use crate::compile::tuning::TUNING;
use crate::compile::{Residual, Tapes};
use crate::simulate::{Schedule, allowed_residual};

/// Steps that follow one another: begin, length and number.
struct Run {
    start: f64,
    h: f64,
    count: usize,
}

/// Steps of a schedule, row by row; steps of one length that end where multiples of it do are one run.
fn runs(schedule: &Schedule) -> Vec<Vec<Run>> {
    let mut now = 0.0;
    let of_row = |row: usize| {
        let mut runs: Vec<Run> = Vec::new();
        for (h, end) in schedule.steps_to(row) {
            match runs.last_mut() {
                Some(last) if last.h == h => last.count += 1,
                _ => runs.push(Run { start: now, h, count: 1 }),
            }
            now = end;
        }
        runs
    };
    (0..schedule.rows).map(of_row).collect()
}

/// Macros by which the runtime names the sizes and registers of the model.
pub(super) fn macros(code: &Code) -> String {
    let Code { simulator, schedule, prefix, method, .. } = code;
    let program = &simulator.program;
    let layout = &program.layout;
    let watched: usize = program.watched.iter().map(|own| own.pivots.len()).sum();
    let flag = usize::from;
    let mut text = String::new();
    for (name, value) in [
        ("N", layout.q.len()),
        ("M", layout.lambda.len()),
        ("PARAMETERS", code.parameters),
        ("PARAMETER", layout.parameters.start),
        ("STEP", layout.step),
        ("TIME", layout.time),
        ("Q", layout.q.start),
        ("V", layout.v.start),
        ("A", layout.a.start),
        ("W", layout.w.start),
        ("LAMBDA", layout.lambda.start),
        ("ITERATE", layout.iterate.start),
        ("CORRECTION", layout.correction.start),
        ("LAYOUT", layout.registers()),
        ("OUTPUTS", program.outputs.len()),
        ("REDUNDANT", program.redundant.len()),
        ("WATCHED", watched),
        ("ROWS", schedule.rows),
        ("CLOSURES", simulator.start.constraint.len()),
        ("CLOSURE_RATES", simulator.start.constraint_rate.len()),
        ("EXPLICIT", flag(method.is_explicit)),
        ("FIXED", flag(code.has_fixed_steps())),
        ("LEVELS", method.levels),
        ("CONTROLLED", flag(method.controller.is_some())),
        ("SWITCHES", method.switches.map_or(0, |program| program.switches.len())),
        ("SAMPLED", simulator.start.sampled.len()),
        ("SINGULAR", flag(method.is_singular)),
        ("SOLVER", flag(method.has_solver)),
        ("EQUILIBRIUM", flag(method.equilibrium.is_some())),
        ("SOLVES", flag(method.solves)),
        ("PROJECTS", flag(method.projects)),
        ("ACCELERATIONS", flag(method.needs.accelerations)),
        ("CLOSES", flag(method.needs.closure)),
        ("LINEAR", flag(method.is_linear())),
    ] {
        let _ = writeln!(text, "#define {name} {value}");
    }
    let coefficients = &program.coefficients;
    let mut numbers = vec![
        ("GAIN", coefficients.position_gain(1.0)),
        ("SHIFT", coefficients.shift()),
        ("START_SHIFT", coefficients.shift() * schedule.first_step()),
        ("CLOSED", allowed_residual(&program.scale)),
        ("INSTANT_ROUNDING", TUNING.instant_rounding),
    ];
    if let Some(controller) = method.controller {
        numbers.extend([
            ("TOLERANCE", controller.tolerance),
            ("DURATION", controller.duration),
            ("LEAST_STEP", controller.least()),
            ("LEAST_EVENT", controller.event()),
            ("ERROR_GAIN", coefficients.error_gain(1.0)),
            ("OF_NEW", coefficients.of_new()),
            ("OF_OLD", coefficients.of_old()),
            ("OF_ALGORITHMIC", coefficients.of_algorithmic()),
        ]);
    }
    for (name, value) in numbers {
        let _ = writeln!(text, "#define {name} {}", c_number(value));
    }
    for (name, own) in [
        ("MODEL", "model"),
        ("STEPPER", "stepper"),
        ("LEVEL", "level"),
        ("MODEL_START", "start"),
        ("MODEL_START_AT", "start_at"),
        ("MODEL_SET", "set"),
        ("MODEL_ROW", "row"),
        ("MODEL_STEP", "step"),
        ("MODEL_TIME", "time"),
        ("MODEL_OBSERVE", "outputs"),
    ] {
        let _ = writeln!(text, "#define {name} {prefix}_{own}");
    }
    text
}

/// The tables that the runtime names.
pub(super) fn tables(code: &Code, start: &Tile) -> String {
    let Code { simulator, schedule, prefix, outputs, method, .. } = code;
    let program = &simulator.program;
    let mut text = String::from("\ntypedef struct { int at; double value; } constant;\n\n");
    let layout = program.layout.registers();
    let _ = writeln!(
        text,
        "static const double start_values[] = {};",
        numbers(&mut start.values()[..layout].iter().copied())
    );
    if !method.is_explicit || method.settles() {
        let _ = writeln!(text, "static const double scale[] = {};", numbers(&mut program.scale.iter().copied()));
    }
    if !method.is_explicit {
        text += &of_steps(code);
    }
    let mut times = (0..schedule.rows).map(|row| schedule.time(row));
    let _ = writeln!(text, "static const double row_times[] = {};", numbers(&mut times));
    let quoted = |texts: &mut dyn Iterator<Item = &str>| {
        list(texts.map(|text| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))))
    };
    let names = quoted(&mut outputs.iter().map(|(name, _)| *name));
    let units = quoted(&mut outputs.iter().map(|(_, unit)| *unit));
    let _ = writeln!(text, "const char *const {prefix}_output_names[] = {names};");
    let _ = writeln!(text, "const char *const {prefix}_output_units[] = {units};");
    if code.parameters > 0 {
        let own = &simulator.system.parameters;
        let names = quoted(&mut own.iter().map(|own| own.name.as_str()));
        let units = quoted(&mut own.iter().map(|own| own.unit.as_str()));
        let values = numbers(&mut own.iter().map(|own| own.nominal));
        let rows = |rows: &[Residual]| registers(&rows.iter().map(|own| own.register).collect::<Vec<_>>());
        let (closures, rates) = (rows(&simulator.start.constraint), rows(&simulator.start.constraint_rate));
        let _ = writeln!(text, "const char *const {prefix}_parameter_names[] = {names};");
        let _ = writeln!(text, "const char *const {prefix}_parameter_units[] = {units};");
        let _ = writeln!(text, "const double {prefix}_parameter_values[] = {values};");
        let _ = writeln!(text, "#define parameter_values {prefix}_parameter_values");
        let _ =
            writeln!(text, "static const int closures[] = {closures};\nstatic const int closure_rates[] = {rates};");
    }
    text += &of_method(code);
    text.push('\n');
    text
}

/// Tables of the steps of HHT-I3.
fn of_steps(code: &Code) -> String {
    let program = &code.simulator.program;
    let mut text = String::from("typedef struct { int pivot; double largest; int mode, inactive; } watched_pivot;\n");
    let _ = writeln!(text, "static const int redundant[] = {};", registers(&program.redundant));
    if code.method.closure.is_none() {
        let _ = writeln!(text, "static const int output_registers[] = {};", registers(&program.outputs));
    }
    let pivots = program.watched.iter().flat_map(|own| {
        let (mode, inactive) = own.mode.map_or((-1, 0), |mode| (mode.register as i64, i32::from(mode.inactive)));
        own.pivots.iter().map(move |pivot| {
            format!("{{ {}, {}, {mode}, {inactive} }}", pivot.register, c_number(pivot.largest_inverse))
        })
    });
    let _ = writeln!(text, "static const watched_pivot watched[] = {};", structs(pivots, "{ 0, 0.0, 0, 0 }"));
    text += &constants("constants", program.constants());
    text += &if code.has_fixed_steps() { of_runs(code.schedule) } else { of_ends(code.schedule) };
    text
}

/// Indices of the first of each row, and the end of the last row, by their numbers.
fn firsts(counts: impl Iterator<Item = usize>) -> String {
    let ends = counts.scan(0, |next, count| {
        *next += count;
        Some(*next)
    });
    registers(&std::iter::once(0).chain(ends).collect::<Vec<_>>())
}

/// Steps of one length, as runs of them.
fn of_runs(schedule: &Schedule) -> String {
    let rows = runs(schedule);
    let all = rows.iter().flatten();
    let all = all.map(|run| format!("{{ {}, {}, {} }}", c_number(run.start), c_number(run.h), run.count));
    format!(
        "typedef struct {{ double start, h; int count; }} run;\n\
         static const run runs[] = {};\n\
         static const int row_runs[] = {};\n",
        structs(all, "{ 0.0, 0.0, 0 }"),
        firsts(rows.iter().map(Vec::len))
    )
}

/// Steps of any lengths, as their ends.
fn of_ends(schedule: &Schedule) -> String {
    let rows: Vec<Vec<f64>> =
        (0..schedule.rows).map(|row| schedule.steps_to(row).map(|(_, end)| end).collect()).collect();
    format!(
        "static const double step_ends[] = {};\nstatic const int row_steps[] = {};\n",
        numbers(&mut rows.iter().flatten().copied()),
        firsts(rows.iter().map(Vec::len))
    )
}
