//! States of one jet at a time: parameters, a consistent start, accelerations.

use symdiff::jet::JetSpace;
use symdiff::{JetMemory, Tile};

use super::tuning::TUNING;
use crate::compile::{StartProgram, Tapes};
use crate::simulate::error::SimulationError;
use crate::simulate::simulator::Simulator;

/// The box about whose centre parameters are expanded: centre and half width of each parameter, in its unit.
#[derive(Clone, Copy, Debug)]
pub struct JetBox<'b> {
    /// Centre.
    pub center: &'b [f64],
    /// Half width.
    pub half_width: &'b [f64],
}

/// The parameters as jets about the box's centre.
pub(super) fn set_parameters(simulator: &Simulator, space: &JetSpace, memory: &mut JetMemory, about: JetBox<'_>) {
    for (variable, register) in simulator.start.layout.parameters.clone().enumerate() {
        space.variable(variable, about.center[variable], about.half_width[variable], memory.jet_mut(register));
    }
}

/// The consistent start of a jet in the start's memory, and of its centre.
///
/// # Errors
/// Where the centre cannot be assembled.
pub(super) fn assembled_jet<'s>(
    simulator: &'s Simulator,
    space: &'s JetSpace,
    about: JetBox<'_>,
    first_step: f64,
) -> Result<(Tile, JetMemory<'s>), SimulationError> {
    let assembled = simulator.assemble(1, first_step, |_| about.center.iter().copied().collect())?;
    let mut start = JetMemory::new(space, simulator.start.registers(), simulator.start.constants());
    for register in simulator.start.layout.state() {
        start.set_constant(register, assembled.lane(register)[0]);
    }
    set_parameters(simulator, space, &mut start, about);
    if let Some(equilibrium) = &simulator.equilibrium {
        let layout = &simulator.start.layout;
        let state = assembled.values()[..layout.registers()].to_vec();
        if let Some(found) = equilibrium.jet(space, about.center, about.half_width, &state) {
            for register in layout.q.clone() {
                start.jet_mut(register).copy_from_slice(found.jet(register));
            }
        }
    }
    consistent(simulator, &mut start, space.monomials().order(), first_step);
    Ok((assembled, start))
}

/// Adds the correction to the unknowns.
pub(super) fn add_correction(memory: &mut JetMemory, unknowns: impl Iterator<Item = usize>, correction: usize) {
    for (index, register) in unknowns.enumerate() {
        let change = memory.jet(correction + index).to_vec();
        memory.jet_mut(register).iter_mut().zip(change).for_each(|(value, change)| *value += change);
    }
}

/// Makes the jet of the start consistent. Its constant terms are consistent already, and every Newton correction in
/// jets doubles the number of orders that are.
fn consistent(simulator: &Simulator, memory: &mut JetMemory, order: usize, first_step: f64) {
    let start = &simulator.start;
    let layout = &start.layout;
    // Least squares converge linearly, though fast.
    let open = if start.open.is_any() { TUNING.least_squares_corrections } else { 0 };
    let corrections = corrections(order) + open;
    memory.run(start.sample());
    memory.run(start.given());
    for _ in 0..corrections {
        memory.run(start.position());
        add_correction(memory, layout.q.clone(), layout.correction.start);
    }
    // Prescribed velocities may depend on the positions.
    memory.run(start.given());
    for _ in 0..corrections {
        memory.run(start.velocity());
        add_correction(memory, layout.v.clone(), layout.correction.start);
    }
    accelerate(simulator, memory, order);
    if !start.sampled.is_empty() {
        sample_states(start, memory, 0.0);
        accelerate(simulator, memory, order);
    }
    shift_accelerations(simulator, memory, order, 0.0, simulator.program.coefficients.shift() * first_step);
}

/// Gives the states that change at a time their new values.
pub(super) fn sample_states(program: &StartProgram, memory: &mut JetMemory, time: f64) {
    memory.run(program.sampling());
    let due = || program.sampled.iter().filter(|sampled| sampled.is_due(time));
    // All are taken before one changes: a value may be another of these states.
    let values: Vec<Vec<f64>> = due().map(|sampled| memory.jet(sampled.value).to_vec()).collect();
    for (sampled, value) in due().zip(&values) {
        memory.jet_mut(sampled.state).copy_from_slice(value);
    }
}

/// a = w(t + shift), as for tiles.
pub(super) fn shift_accelerations(simulator: &Simulator, memory: &mut JetMemory, order: usize, time: f64, shift: f64) {
    let layout = &simulator.start.layout;
    let saved: Vec<Vec<f64>> = layout.state().map(|register| memory.jet(register).to_vec()).collect();
    let state = |register: usize| &saved[register - layout.q.start];
    for ((q, v), w) in layout.q.clone().zip(layout.v.clone()).zip(layout.w.clone()) {
        for index in 0..state(q).len() {
            memory.jet_mut(q)[index] += shift * (state(v)[index] + 0.5 * shift * state(w)[index]);
            memory.jet_mut(v)[index] += shift * state(w)[index];
        }
    }
    memory.set_constant(layout.time, time + shift);
    accelerate(simulator, memory, order);
    let shifted: Vec<Vec<f64>> = layout.w.clone().map(|register| memory.jet(register).to_vec()).collect();
    for (register, saved) in layout.state().zip(&saved) {
        memory.jet_mut(register).copy_from_slice(saved);
    }
    for (register, shifted) in layout.a.clone().zip(&shifted) {
        memory.jet_mut(register).copy_from_slice(shifted);
    }
    memory.set_constant(layout.time, time);
}

/// Newton corrections that make a jet of this order consistent.
pub(in crate::simulate) fn corrections(order: usize) -> usize {
    (order + 1).ilog2() as usize + 2
}

/// Accelerations and multipliers of the start's memory at its positions, velocities and time.
pub(super) fn accelerate(simulator: &Simulator, memory: &mut JetMemory, order: usize) {
    solve_accelerations(&simulator.start, memory, order);
}

/// Accelerations and multipliers in a program's memory at its positions, velocities and time.
pub(super) fn solve_accelerations(program: &StartProgram, memory: &mut JetMemory, order: usize) {
    let layout = &program.layout;
    for _ in 0..corrections(order) {
        memory.run(program.acceleration());
        add_correction(memory, layout.w.clone().chain(layout.lambda.clone()), layout.correction.start);
    }
}
