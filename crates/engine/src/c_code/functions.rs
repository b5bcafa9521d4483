//! The tapes as functions of a memory.

use symdiff::{CWriter, Tape};

use super::Code;
use crate::compile::Tapes;

/// The functions that the runtime calls.
pub(super) fn functions(code: &Code, writer: &mut CWriter) -> String {
    tapes(code).into_iter().map(|(name, tape)| writer.function(name, tape)).collect()
}

fn tapes<'c>(code: &Code<'c>) -> Vec<(&'static str, &'c Tape)> {
    let (program, start, method) = (&code.simulator.program, &code.simulator.start, &code.method);
    let has_levels = !method.is_explicit;
    let mut tapes = Vec::new();
    if has_levels {
        tapes.extend([
            ("sample", program.sample()),
            ("step_size", program.step_size()),
            ("step", program.step()),
            ("factor", program.factor()),
            ("first_correction", program.first_correction()),
            ("correct", program.correct()),
            ("advance", program.advance()),
        ]);
    }
    let mut add = |is_called: bool, name: &'static str, tape: &'c Tape| tapes.extend(is_called.then_some((name, tape)));
    add(method.closure.is_none(), "observe", program.observe());
    add(method.controller.is_some(), "estimate", program.estimate());
    add(method.is_singular, "matrix", program.matrix());
    let has_parameters = code.parameters > 0;
    add(method.has_solver, "solver_sample", start.sample());
    add(method.accelerates(), "solver_acceleration", start.acceleration());
    add(method.projects, "solver_projection", start.projection());
    add(method.has_solver && method.is_sampled, "solver_sampling", start.sampling());
    add(has_parameters, "solver_given", start.given());
    add(has_parameters, "solver_position", start.position());
    add(has_parameters, "solver_velocity", start.velocity());
    if let Some(equilibrium) = method.equilibrium {
        let program = equilibrium.program();
        add(true, "balance_sample", program.sample());
        add(true, "balance_residual", program.residual());
        add(true, "balance_jacobian", program.jacobian());
    }
    if let Some(closure) = method.closure {
        let of_rows = method.needs.accelerations;
        add(true, "closure_sample", closure.sample());
        add(method.needs.closure, "closure_position", closure.position());
        add(method.needs.closure, "closure_projection", closure.projection());
        add(method.is_explicit || of_rows, "closure_acceleration", closure.acceleration());
        add(method.is_explicit && method.is_sampled, "closure_sampling", closure.sampling());
        add(true, "closure_observe", closure.observe());
    }
    if let Some(switches) = method.switches {
        add(true, "switch_sample", switches.sample());
        add(true, "switch_values", switches.evaluate());
    }
    tapes
}
