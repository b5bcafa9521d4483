//! Tables besides those of the steps of HHT-I3: of the start, closed rows, switches, instants and the explicit method.

use std::fmt::Write;

use symdiff::c_number;

use super::Code;
use crate::compile::{Program, SampledValue, Switch, Tapes};
use crate::simulate::explicit::{DENSE, STAGES, TIMES, WEIGHTS, WITH_DENSE};
use crate::simulate::{Equilibrium, level_weights};

/// Tables of a model's way of integration.
pub(super) fn of_method(code: &Code) -> String {
    let (start, method) = (&code.simulator.start, &code.method);
    let mut text = String::new();
    if method.is_singular {
        text += &of_singular(&code.simulator.program);
    }
    if method.has_solver {
        text += &constants("solver_constants", start.constants());
    }
    if method.is_sampled {
        let states: Vec<usize> = start.sampled.iter().map(|own| own.state).collect();
        let periods = numbers(&mut start.sampled.iter().map(|own| own.period));
        let _ = writeln!(text, "static const int sampled_states[] = {};", registers(&states));
        let _ = writeln!(text, "static const double sampled_periods[] = {periods};");
    }
    if method.is_sampled && method.has_solver {
        text += &new_values("solver_values", &start.sampled);
    }
    if let Some(closure) = method.closure {
        text += &constants("closure_constants", closure.constants());
        let _ = writeln!(text, "static const int closure_outputs[] = {};", registers(&closure.outputs));
        if method.is_sampled && method.is_explicit {
            text += &new_values("closure_values", &closure.sampled);
        }
    }
    if method.levels > 1 {
        let weights = numbers(&mut level_weights(method.levels).into_iter());
        let _ = writeln!(text, "static const double level_weights[] = {weights};");
    }
    if let Some(program) = method.switches {
        text += &constants("switch_constants", program.constants());
        text += &of_switches(&program.switches);
    }
    if method.is_explicit {
        text += &of_explicit(code);
    }
    if let Some(equilibrium) = method.equilibrium {
        text += &of_equilibrium(code, equilibrium);
    }
    text
}

/// Registers of the new values of states that change at instants.
fn new_values(name: &str, sampled: &[SampledValue]) -> String {
    let values: Vec<usize> = sampled.iter().map(|own| own.value).collect();
    format!("static const int {name}[] = {};\n", registers(&values))
}

/// Registers of values and rates, and the switches with which each jumps: those from its own `jumps` to the next one's.
fn of_switches(switches: &[Switch]) -> String {
    let others: Vec<usize> = switches.iter().flat_map(|switch| switch.jumps_with.iter().copied()).collect();
    let first = switches.iter().scan(0, |next, switch| {
        let first = *next;
        *next += switch.jumps_with.len();
        Some(first)
    });
    let line = |(switch, jumps): (&Switch, usize)| {
        let rate = switch.rate.map_or("-1".to_owned(), |rate| rate.to_string());
        format!("{{ {}, {rate}, {jumps} }}", switch.value)
    };
    let lines = switches.iter().zip(first).map(line).chain([format!("{{ 0, -1, {} }}", others.len())]);
    format!(
        "typedef struct {{ int value, rate, jumps; }} switch_place;\n\
         static const switch_place switch_registers[] = {};\n\
         static const int jumps_with[] = {};\n",
        structs(lines, ""),
        registers(&others)
    )
}

/// The explicit method's coefficients, and the ends of its steps.
fn of_explicit(code: &Code) -> String {
    let rows = WEIGHTS.iter().chain(&DENSE);
    let first: Vec<usize> = rows
        .clone()
        .scan(0, |next, row| {
            *next += row.len();
            Some(*next)
        })
        .collect();
    let first: Vec<usize> = std::iter::once(0).chain(first).collect();
    let terms = rows.flat_map(|row| row.iter()).map(|(stage, weight)| format!("{{ {stage}, {} }}", c_number(*weight)));
    let ends = code.schedule.ends();
    let last = match ends[..] {
        [.., before, last] => last - before,
        _ => code.schedule.end(),
    };
    format!(
        "typedef struct {{ int stage; double weight; }} term;\n\
         enum {{ STAGES = {STAGES}, WITH_DENSE = {WITH_DENSE}, STEPS = {} }};\n\
         #define LAST_STEP {}\n\
         static const term terms[] = {};\n\
         static const int stage_terms[] = {};\n\
         static const double stage_times[] = {};\n\
         static const double step_ends[] = {};\n",
        ends.len(),
        c_number(last),
        structs(terms, ""),
        registers(&first),
        numbers(&mut TIMES.into_iter()),
        numbers(&mut ends.iter().copied()),
    )
}

/// The matrix of a step before its elimination.
fn of_singular(program: &Program) -> String {
    let entries = program.matrix_entries.iter().map(|(row, column, at)| format!("{{ {row}, {column}, {at} }}"));
    format!(
        "typedef struct {{ int row, column, at; }} matrix_entry;\n\
         enum {{ MATRIX_ENTRIES = {} }};\n\
         static const matrix_entry matrix_entries[] = {};\n\
         static const int matrix_residuals[] = {};\n\
         static const double equilibration[] = {};\n\
         static const double constraint_rounding[] = {};\n",
        program.matrix_entries.len(),
        structs(entries, "{ 0, 0, 0 }"),
        registers(&program.residual),
        numbers(&mut program.equilibration.iter().copied()),
        numbers(&mut program.rounding.iter().copied()),
    )
}

/// Equations at rest: registers of the residuals, and entries of their derivatives by positions and multipliers.
fn of_equilibrium(code: &Code, equilibrium: &Equilibrium) -> String {
    let program = equilibrium.program();
    let layout = &program.layout;
    let n = layout.q.len();
    let [by_position, _, _, by_multiplier] = &program.motion_by;
    let is_redundant = |row: usize| code.simulator.program.redundant.contains(&(layout.lambda.start + row));
    let of_multipliers = by_multiplier.iter().map(|&(row, column, at)| (row, n + column, at));
    let of_constraints = program.constraint_by_position.iter().filter(|(row, ..)| !is_redundant(*row));
    let of_constraints = of_constraints.map(|&(row, column, at)| (n + row, column, at));
    let entries: Vec<String> = by_position
        .iter()
        .copied()
        .chain(of_multipliers)
        .chain(of_constraints)
        .map(|(row, column, at)| format!("{{ {row}, {column}, {at} }}"))
        .collect();
    let states: Vec<String> =
        equilibrium.states().map(|(position, value)| format!("{{ {position}, {value} }}")).collect();
    let rows: Vec<usize> = program.motion.iter().chain(&program.constraint).copied().collect();
    // The table is there already where there are steps.
    let redundant = match code.method.is_explicit {
        true => format!("static const int redundant[] = {};\n", registers(&code.simulator.program.redundant)),
        false => String::new(),
    };
    format!(
        "{}{redundant}typedef struct {{ int row, column, at; }} entry;\n\
         typedef struct {{ int position, value; }} resting_state;\n\
         enum {{ BALANCE_ENTRIES = {}, BALANCE_STATES = {} }};\n\
         static const entry balance_entries[] = {};\n\
         static const resting_state balance_states[] = {};\n\
         static const int balance_rows[] = {};\n",
        constants("balance_constants", program.constants()),
        entries.len(),
        states.len(),
        structs(entries.into_iter(), "{ 0, 0, 0 }"),
        structs(states.into_iter(), "{ 0, 0 }"),
        registers(&rows),
    )
}

/// Numbers that a new memory holds, as a table with its size.
pub(super) fn constants(name: &str, values: &[(u32, f64)]) -> String {
    let all = structs(values.iter().map(|(at, value)| format!("{{ {at}, {} }}", c_number(*value))), "{ 0, 0.0 }");
    format!("enum {{ {} = {} }};\nstatic const constant {name}[] = {all};\n", name.to_uppercase(), values.len())
}

pub(super) fn numbers(values: &mut dyn Iterator<Item = f64>) -> String {
    list(values.map(c_number))
}

pub(super) fn registers(values: &[usize]) -> String {
    list(values.iter().map(usize::to_string))
}

/// Values in braces, eight a line; C has no empty lists.
pub(super) fn list(values: impl Iterator<Item = String>) -> String {
    structs(values, "0")
}

/// The same of any values, with a value for an empty list.
pub(super) fn structs(values: impl Iterator<Item = String>, none: &str) -> String {
    let mut values: Vec<String> = values.collect();
    if values.is_empty() {
        values.push(none.to_owned());
    }
    let lines: Vec<String> = values.chunks(8).map(|line| line.join(", ")).collect();
    format!("{{\n    {}\n}}", lines.join(",\n    "))
}
