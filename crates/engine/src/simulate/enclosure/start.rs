//! The start, enclosed: positions, velocities, accelerations and multipliers as solutions of their equations.

use symdiff::taylor_model::ModelSpace;
use symdiff::{Interval, ModelMemory, Tape};

use super::EnclosureError;
use crate::assemble::{CoordinateId, ResidualUnit, System};
use crate::certificate::krawczyk::{self, Image};
use crate::certificate::matrix::Models;
use crate::compile::EquationsProgram;
use crate::simulate::closure::choose_independent;
use crate::simulate::simulator::Simulator;

/// A square system of equations among a program's registers.
pub(super) struct SquareSystem<'p> {
    /// Registers of the unknowns.
    unknowns: Vec<usize>,
    /// Registers of the residuals, after `residual`.
    residuals: Vec<usize>,
    residual: Vec<&'p Tape>,
    slopes: &'p Tape,
    /// (residual, unknown, register) after `slopes`.
    entries: Vec<(usize, usize, usize)>,
    /// Arguments of conditions and signs, and their registers: known if all unknowns are.
    conditions: Option<(&'p Tape, &'p [usize])>,
}

/// Leaves the start's q, v, a, w, λ in the memory at t = 0; `shift` is αh. The nominal start selects the solution.
pub(super) fn assemble(
    simulator: &Simulator,
    program: &EquationsProgram,
    space: &ModelSpace,
    memory: &mut ModelMemory,
    shift: f64,
) -> Result<(), EnclosureError> {
    let layout = &program.layout;
    for register in layout.state() {
        space.constant(Interval::point(simulator.nominal[register]), memory.model_mut(register));
    }
    set_time(space, memory, layout.time, 0.0);
    let starts = [layout.q.start, layout.v.start];
    for (level, (kept, start)) in program.kept.iter().zip(starts).enumerate() {
        // Given velocities may be functions of the positions, which are known by then.
        memory.run(program.given());
        for &(index, given) in kept {
            let value = memory.model(given).to_vec();
            memory.model_mut(start + index).copy_from_slice(&value);
        }
        let free = free(program, level);
        if is_at_nominal(simulator, program, level) {
            // The memory has these values.
            continue;
        }
        let column = |index: usize| free.iter().position(|&known| known == index);
        let slopes = program.closure_by[level].iter();
        let entries = slopes.filter_map(|&(row, index, register)| Some((row, column(index)?, register))).collect();
        let equations = SquareSystem {
            unknowns: free.iter().map(|index| start + index).collect(),
            residuals: program.closure[level].clone(),
            residual: vec![program.closure()],
            slopes: program.closure_jacobian(),
            entries,
            conditions: None,
        };
        equations.solve(space, memory)?;
    }
    let accelerations = accelerations(program);
    accelerations.solve(space, memory)?;

    // a = w(t + αh) to first order: the accelerations of the state moved there.
    let saved: Vec<Vec<f64>> = layout.state().map(|register| memory.model(register).to_vec()).collect();
    let state = |register: usize| &saved[register - layout.q.start];
    let (shift_by, half) = (Interval::point(shift), Interval::point(0.5 * shift));
    let (mut moved, mut term) = (vec![0.0; space.size()], vec![0.0; space.size()]);
    for ((q, v), w) in layout.q.clone().zip(layout.v.clone()).zip(layout.w.clone()) {
        space.scale(half, state(w), &mut term);
        space.add(state(v), &term, &mut moved);
        space.scale(shift_by, &moved, &mut term);
        space.add(state(q), &term, memory.model_mut(q));
        space.scale(shift_by, state(w), &mut term);
        space.add(state(v), &term, memory.model_mut(v));
    }
    set_time(space, memory, layout.time, shift);
    accelerations.solve(space, memory)?;
    let shifted: Vec<Vec<f64>> = layout.w.clone().map(|register| memory.model(register).to_vec()).collect();
    for (register, saved) in layout.state().zip(&saved) {
        memory.model_mut(register).copy_from_slice(saved);
    }
    for (register, shifted) in layout.a.clone().zip(&shifted) {
        memory.model_mut(register).copy_from_slice(shifted);
    }
    set_time(space, memory, layout.time, 0.0);
    Ok(())
}

/// If all parameters of an orientation are given, the one that is largest at the nominal start follows from the others
/// by the normalisation: given numbers fulfil it but for their rounding.
pub(super) fn leave_to_normalisations(system: &mut System, nominal: &[f64]) {
    for (info, &constraint) in system.constraints.iter().zip(&system.constraint) {
        if info.unit != ResidualUnit::Number || !info.name.ends_with(".norm") {
            continue;
        }
        let symbols = system.graph.symbols_of(&[constraint]);
        let own: Vec<usize> =
            (0..system.q.len()).filter(|&index| symbols.binary_search(&system.q[index]).is_ok()).collect();
        let largest = own.iter().copied().max_by(|&a, &b| nominal[a].abs().total_cmp(&nominal[b].abs()));
        for given in [&mut system.start.position, &mut system.start.velocity] {
            if let Some(largest) = largest.filter(|_| own.iter().all(|&index| given[index].is_some())) {
                given[largest] = None;
            }
        }
    }
}

/// Coordinates whose position (level 0), or velocity (1), is not given.
pub(super) fn free(program: &EquationsProgram, level: usize) -> Vec<usize> {
    let is_free = |index: &usize| program.kept[level].iter().all(|(known, _)| known != index);
    (0..program.layout.q.len()).filter(is_free).collect()
}

/// Whether all else is open, and stays at the nominal values for every ξ.
pub(super) fn is_at_nominal(simulator: &Simulator, program: &EquationsProgram, level: usize) -> bool {
    let free = free(program, level);
    let start = [program.layout.q.start, program.layout.v.start][level];
    let nominal = |index: usize| simulator.nominal[start + index];
    let is_known = match level {
        0 => program.closure[0].is_empty() && free.iter().all(|&q| program.guess[q] == Some(nominal(q))),
        _ => program.can_rest && free.iter().all(|&v| nominal(v) == 0.0),
    };
    program.closure[level].len() < free.len() && is_known
}

/// ∂q/∂(independent coordinates), n × f, and P (see [`super::frame`]), n × m, at the start, and which coordinates
/// are independent.
pub(super) fn tangent(
    simulator: &Simulator,
    program: &EquationsProgram,
    space: &ModelSpace,
    memory: &mut ModelMemory,
) -> Result<(Models, Models, Vec<CoordinateId>), EnclosureError> {
    let layout = &program.layout;
    let (n, m) = (layout.q.len(), program.constraint.len());
    let motion = &simulator.nominal[layout.q.start..layout.v.end];
    let parameters = &simulator.nominal[layout.parameters.clone()];
    let chosen = choose_independent(simulator, parameters, motion, 0.0);
    let independent: Vec<usize> = chosen.iter().map(|coordinate| coordinate.number()).collect();
    let dependent: Vec<usize> = (0..n).filter(|index| !independent.contains(index)).collect();
    if dependent.len() != m {
        return Err(EnclosureError::Undetermined);
    }
    memory.run(program.jacobian());
    let (mut mass, mut slopes) = (Models::zero(space, n + m, n + m), Models::zero(space, m, n));
    for &(row, column, register) in &program.motion_by[2] {
        mass.at_mut(row, column).copy_from_slice(memory.model(register));
    }
    for &(row, column, register) in &program.constraint_by_position {
        mass.at_mut(n + row, column).copy_from_slice(memory.model(register));
        mass.at_mut(column, n + row).copy_from_slice(memory.model(register));
        slopes.at_mut(row, column).copy_from_slice(memory.model(register));
    }
    let mut tangent = Models::zero(space, n, independent.len());
    independent.iter().enumerate().for_each(|(column, &row)| tangent.at_mut(row, column)[0] = 1.0);
    let follow = inverse(space, &slopes.columns_at(space, &dependent))?;
    let mut follow = follow.approximate_times(space, &slopes.columns_at(space, &independent));
    follow.negate();
    for (index, &row) in dependent.iter().enumerate() {
        (0..independent.len()).for_each(|column| tangent.at_mut(row, column).copy_from_slice(follow.at(index, column)));
    }
    let push = inverse(space, &mass)?.part(space, 0..n, n..n + m);
    Ok((tangent, push, chosen))
}

fn inverse(space: &ModelSpace, matrix: &Models) -> Result<Models, EnclosureError> {
    let mut inverse = matrix.inverse_at_centre(space).ok_or(EnclosureError::Undetermined)?;
    if inverse.refine_inverse_of(space, matrix) { Ok(inverse) } else { Err(EnclosureError::Unproven) }
}

fn set_time(space: &ModelSpace, memory: &mut ModelMemory, register: usize, time: f64) {
    space.constant(Interval::point(time), memory.model_mut(register));
}

/// M w + Φ_qᵀ λ − Q = 0 and Φ̈ = 0, whose derivative by w is Φ_q.
pub(super) fn accelerations(program: &EquationsProgram) -> SquareSystem<'_> {
    let layout = &program.layout;
    let n = layout.q.len();
    let [_, _, by_w, by_lambda] = &program.motion_by;
    let mut entries = by_w.clone();
    entries.extend(by_lambda.iter().map(|&(row, column, register)| (row, n + column, register)));
    entries.extend(program.constraint_by_position.iter().map(|&(row, column, register)| (n + row, column, register)));
    SquareSystem {
        unknowns: layout.w.clone().chain(layout.lambda.clone()).collect(),
        residuals: program.motion.iter().chain(&program.constraint_rates[1]).copied().collect(),
        residual: vec![program.residual(), program.rates()],
        slopes: program.jacobian(),
        entries,
        conditions: Some((program.conditions(), &program.conditions)),
    }
}

impl SquareSystem<'_> {
    /// Encloses the unknowns, from the approximation in the memory.
    pub(super) fn solve(&self, space: &ModelSpace, memory: &mut ModelMemory) -> Result<(), EnclosureError> {
        if self.unknowns.len() != self.residuals.len() {
            return Err(EnclosureError::Undetermined);
        }
        if self.unknowns.is_empty() {
            return Ok(());
        }
        self.set_radii(space, memory, None);
        let mut inverse = self.matrix(space, memory).inverse_at_centre(space).ok_or(EnclosureError::Unproven)?;
        // Each correction makes at least one more order exact, and doubles their number where C is exact too.
        for _ in 0..space.jets().monomials().order().max(1).ilog2() + 5 {
            let matrix = self.matrix(space, memory);
            if !inverse.refine_inverse_of(space, &matrix) {
                return Err(EnclosureError::Unproven);
            }
            let correction = inverse.approximate_times(space, &self.residual(space, memory));
            for (index, &register) in self.unknowns.iter().enumerate() {
                let change = correction.at(index, 0);
                memory.model_mut(register).iter_mut().zip(change).for_each(|(x, change)| *x -= change);
            }
        }
        self.prove(space, memory, &inverse)
    }

    /// Gives the unknowns radii within which, about the polynomials in the memory, a solution is for every ξ. `inverse`
    /// approximates that of the matrix.
    pub(super) fn prove(
        &self,
        space: &ModelSpace,
        memory: &mut ModelMemory,
        inverse: &Models,
    ) -> Result<(), EnclosureError> {
        self.set_radii(space, memory, None);
        let sizes = inverse.bounds(space);
        let missed = sizes.times(self.residual(space, memory).bounds(space).entries());
        let spread = krawczyk::enclose(missed.clone(), |y| {
            self.set_radii(space, memory, Some(y));
            let contraction = inverse.times(space, &self.matrix(space, memory)).off_identity(space).bounds(space);
            Image { missed: missed.clone(), contraction }
        });
        let spread = spread.ok_or(EnclosureError::Unproven)?;
        self.set_radii(space, memory, Some(&spread));
        let Some((tape, registers)) = self.conditions.filter(|(_, registers)| !registers.is_empty()) else {
            return Ok(());
        };
        memory.run(tape);
        let are_known = registers.iter().all(|&register| space.sign(memory.model(register)).is_some());
        if are_known { Ok(()) } else { Err(EnclosureError::Unproven) }
    }

    fn set_radii(&self, space: &ModelSpace, memory: &mut ModelMemory, radii: Option<&[f64]>) {
        for (index, &register) in self.unknowns.iter().enumerate() {
            memory.model_mut(register)[space.size() - 1] = radii.map_or(0.0, |radii| radii[index]);
        }
    }

    /// Residuals over the models in the memory.
    pub(super) fn residual(&self, space: &ModelSpace, memory: &mut ModelMemory) -> Models {
        self.residual.iter().for_each(|tape| memory.run(tape));
        let mut residual = Models::zero(space, self.residuals.len(), 1);
        for (row, &register) in self.residuals.iter().enumerate() {
            residual.at_mut(row, 0).copy_from_slice(memory.model(register));
        }
        residual
    }

    /// Derivatives by the unknowns over the models in the memory.
    pub(super) fn matrix(&self, space: &ModelSpace, memory: &mut ModelMemory) -> Models {
        memory.run(self.slopes);
        let mut matrix = Models::zero(space, self.residuals.len(), self.unknowns.len());
        for &(row, column, register) in &self.entries {
            matrix.at_mut(row, column).copy_from_slice(memory.model(register));
        }
        matrix
    }
}
