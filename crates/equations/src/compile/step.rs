//! System → [`Program`]: the equations of a step, their elimination, the tapes.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Input, SparseMatrix, Stages, lower_where, with_reciprocals};

use super::elimination::{Elimination, PivotChoice, Version, is_worthwhile};
use super::equations::Equation;
use super::first_correction::first_correction;
use super::layout::Layout;
use super::links;
use super::newton_matrix::{ITERATION, NewtonSystem, STEP_SIZE, newton_system};
use super::program::{FACTOR, MATRIX, OBSERVE, PivotSample, Program};
use super::rounding::running_errors;
use super::scheme::{ConstraintLevel, Scheme};
use super::sparse_lu::{NoFactors, Numbers, Pivoting};
use super::tuning::TUNING;
use crate::assemble::{ConstraintId, System};

/// A value to compute, and the register that it must have, if any.
type Target = (Expr, Option<u32>);

/// Compiles a system. `redundant` are constraints that others imply; pivots are good near the states of `samples`.
///
/// # Errors
/// Where the Newton matrix has no acceptable pivots at the samples, and where the graph is full.
pub fn compile(
    system: &System,
    scheme: Scheme,
    redundant: &[ConstraintId],
    samples: &[PivotSample; TUNING.pivot_samples],
) -> Result<Program, NoFactors<Equation>> {
    let compiled = |by_links| compile_as(system, scheme, redundant, samples, by_links);
    match links::elimination(system, !redundant.is_empty()) {
        links::LinkElimination::Whole => compiled(false),
        links::LinkElimination::Links => compiled(true).or_else(|_| compiled(false)),
        links::LinkElimination::Shorter => {
            let whole = compiled(false);
            let Ok(by_links) = compiled(true) else { return whole };
            let is_shorter = whole.as_ref().is_ok_and(|whole| whole.instructions() <= by_links.instructions());
            if is_shorter { whole } else { Ok(by_links) }
        }
    }
}

/// Compiles with the Newton matrix eliminated as a whole, or link by link.
fn compile_as(
    system: &System,
    scheme: Scheme,
    redundant: &[ConstraintId],
    samples: &[PivotSample; TUNING.pivot_samples],
    by_links: bool,
) -> Result<Program, NoFactors<Equation>> {
    let layout = Layout::of(system);
    let coefficients = scheme.coefficients();
    let mut graph = system.graph.clone();
    let (newton, mut inputs) = newton_system(system, &mut graph, &layout, coefficients, by_links);
    let newton = newton.map(|values| with_reciprocals(&mut graph, &inputs, values));
    let (active, inactive) = factors(system, &mut graph, &newton, &inputs, redundant, samples)
        .map_err(|none| none.named(|row| Equation::of_row(row, system.q.len())))?;
    let mut rounding = match coefficients.level {
        ConstraintLevel::Position => rounding_of_constraints(system, &inputs, samples),
        ConstraintLevel::Velocity => Vec::new(),
    };
    rounding.resize(system.lambda.len(), 0.0);
    let mut next = layout.registers() as u32;
    let elimination = Elimination::new(&mut graph, &mut inputs, &mut next, active, inactive);
    let [correct, estimate] = solutions(&mut graph, &newton, &elimination, &layout);
    let Elimination { mut frozen, guards, watched, active: Version { factors, mut equilibration }, .. } = elimination;
    equilibration.truncate(newton.residual.len());
    let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
    let observe = with_reciprocals(&mut graph, &inputs, &outputs).into_iter().map(|output| (output, None)).collect();
    let mut matrix: Vec<Target> = newton.matrix.entries().map(|(_, _, value)| (value, None)).collect();
    matrix.extend(newton.residual.iter().map(|&value| (value, None)));
    let first = first_correction(&mut graph, &mut inputs, &mut next, &mut frozen, &guards, &correct);
    let guards = guards.into_iter().map(|(value, guard)| ((FACTOR, value), guard)).collect();
    let kernels = [frozen, first, correct, advanced_state(&newton, &layout), observe, matrix, estimate];
    let lowered = lower_where(&graph, &inputs, ITERATION, next, &kernels, &guards);
    debug_assert_eq!(lowered.stages.len(), STEP_SIZE + 2);
    let nonzeros = newton.matrix.nonzeros();
    let registers = &lowered.outputs[MATRIX];
    let matrix_entries = newton
        .matrix
        .entries()
        .zip(registers)
        .map(|((row, column, _), &register)| (row, column, register as usize))
        .collect();
    Ok(Program {
        coefficients,
        scale: system.coordinates.iter().map(|coordinate| coordinate.scale).collect(),
        outputs: lowered.outputs[OBSERVE].iter().map(|&register| register as usize).collect(),
        matrix_entries,
        size: newton.matrix.rows.len(),
        residual: registers[nonzeros..].iter().map(|&register| register as usize).collect(),
        rounding,
        redundant: redundant.iter().map(|&constraint| layout.lambda.start + constraint.number()).collect(),
        watched,
        equilibration,
        nonzeros: (nonzeros, factors.nonzeros()),
        pivots: factors
            .pivots
            .iter()
            .map(|pivot| (pivot.row, pivot.column))
            .filter(|&(row, _)| row < newton.residual.len())
            .collect(),
        layout,
        lowered,
    })
}

/// The Newton matrix's factors in one version, or in two with the condition that decides between them.
fn factors(
    system: &System,
    graph: &mut Graph,
    newton: &NewtonSystem,
    inputs: &[Input],
    redundant: &[ConstraintId],
    samples: &[PivotSample; TUNING.pivot_samples],
) -> Result<(Version, Option<(Expr, Version)>), NoFactors> {
    let n = system.q.len();
    let numbers = sample_numbers(graph, &newton.matrix, inputs, samples);
    let massive = &system.massive[..];
    let blocks = mass_blocks(system);
    let symmetric = Pivoting::Symmetric { massive, blocks: &blocks };
    let choice = PivotChoice { redundant, symmetric, spatial: system.space.spatial, n, first: &newton.first };
    let factorised = |graph: &mut Graph, matrix: &SparseMatrix, numbers: &[Numbers]| {
        choice.factorise(graph, matrix, numbers, equilibrate(matrix, numbers, massive), inputs)
    };
    let versions = versions(graph, newton, &numbers, inputs).and_then(|[active, inactive]| {
        let inactive_numbers = sample_numbers(graph, &inactive.0, inputs, samples);
        // If elimination needs the conditional forces, there is no second version.
        let active = factorised(graph, &active.0, &active.1).ok()?;
        let inactive = factorised(graph, &inactive.0, &inactive_numbers).ok()?;
        is_worthwhile(graph, inputs, &active, &inactive).then_some((active, inactive))
    });
    match (versions, newton.active_condition) {
        (Some((active, inactive)), Some(condition)) => Ok((active, Some((condition, inactive)))),
        _ => Ok((factorised(graph, &newton.matrix, &numbers)?, None)),
    }
}

/// The correction, and the part of a₊ − a that moves the mechanism.
fn solutions(graph: &mut Graph, newton: &NewtonSystem, elimination: &Elimination, layout: &Layout) -> [Vec<Target>; 2] {
    let (size, zero) = (newton.matrix.rows.len(), graph.constant(0.0));
    let mut opposite: Vec<Expr> = newton.residual.iter().map(|&value| graph.neg(value)).collect();
    opposite.resize(size, zero);
    let mut correction = elimination.solve(graph, &opposite);
    correction.truncate(newton.residual.len());
    let mut changes = newton.inertial_change.clone();
    changes.resize(size, zero);
    let moving = elimination.solve(graph, &changes);
    let moving = &moving[..newton.inertial_change.len()];
    [at(&correction, layout.correction.start), at(moving, layout.correction.start)]
}

/// q₊, v₊, a₊ and w₊ in the registers of the state.
fn advanced_state(newton: &NewtonSystem, layout: &Layout) -> Vec<Target> {
    let mut advance = at(&newton.position, layout.q.start);
    advance.extend(at(&newton.velocity, layout.v.start));
    advance.extend(at(&newton.algorithmic, layout.a.start));
    advance.extend(at(&newton.acceleration, layout.w.start));
    advance
}

/// Values in consecutive registers.
fn at(values: &[Expr], start: usize) -> Vec<Target> {
    values.iter().zip(start..).map(|(&value, register)| (value, Some(register as u32))).collect()
}

/// The Newton matrix with its numbers where the conditional forces are active, and where they are inactive; `None` if
/// the two are the same.
fn versions(
    graph: &mut Graph,
    newton: &NewtonSystem,
    numbers: &[Numbers],
    inputs: &[Input],
) -> Option<[(SparseMatrix, Vec<Numbers>); 2]> {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    // A condition that the iteration does not change needs no second elimination.
    let condition = newton.active_condition.filter(|&condition| stages.of(condition) == Some(ITERATION))?;
    let values: Vec<Expr> = newton.matrix.entries().map(|(_, _, value)| value).collect();
    let versions = [true, false].map(|holds| {
        let (mut matrix, mut kept) = (SparseMatrix::zero(newton.matrix.rows.len(), newton.matrix.columns), Vec::new());
        let values = graph.assume(&values, condition, holds);
        for (((row, column, _), value), numbers) in newton.matrix.entries().zip(values).zip(numbers) {
            if !graph.is_zero(value) {
                matrix.rows[row].push((column, value));
                kept.push(*numbers);
            }
        }
        (matrix, kept)
    });
    (versions[0].0 != versions[1].0).then_some(versions)
}

/// For each coordinate, the first of those that M couples it with: the coordinates of a body, or of a tree of bodies.
/// If M is omitted, all are one block.
fn mass_blocks(system: &System) -> Vec<usize> {
    if system.is_mass_left_out() {
        return vec![0; system.q.len()];
    }
    let mut coupled: Vec<Vec<usize>> = vec![Vec::new(); system.q.len()];
    system.mass.iter().for_each(|&(row, column, _)| coupled[row].push(column));
    let mut blocks = vec![usize::MAX; system.q.len()];
    for first in 0..blocks.len() {
        let mut next = vec![first];
        while let Some(coordinate) = next.pop().filter(|_| blocks[first] >= first) {
            if blocks[coordinate] == usize::MAX {
                blocks[coordinate] = first;
                next.extend(&coupled[coordinate]);
            }
        }
    }
    blocks
}

/// Values of the matrix's entries at each pivot sample, of which the first is the nominal start.
fn sample_numbers(
    graph: &Graph,
    matrix: &SparseMatrix,
    inputs: &[Input],
    samples: &[PivotSample; TUNING.pivot_samples],
) -> Vec<Numbers> {
    let register_of = registers(inputs);
    let entries: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
    let mut values: Vec<Vec<f64>> =
        samples.iter().map(|sample| graph.evaluate(&entries, |symbol| sample.values[register_of[&symbol]])).collect();
    // Away from the start a force may have no number, as that of a gas whose volume is negative there.
    let (nominal, others) = values.split_at_mut(1);
    for sample in others {
        let unknown = sample.iter().zip(&nominal[0]).any(|(value, nominal)| !value.is_finite() && nominal.is_finite());
        if unknown {
            sample.clone_from(&nominal[0]);
        }
    }
    (0..entries.len()).map(|entry| std::array::from_fn(|sample| values[sample][entry])).collect()
}

/// Register of each symbol.
fn registers(inputs: &[Input]) -> FxHashMap<Expr, usize> {
    inputs.iter().map(|input| (input.symbol, input.register as usize)).collect()
}

/// Rounding error of each constraint, the largest of the pivot samples.
fn rounding_of_constraints(
    system: &System,
    inputs: &[Input],
    samples: &[PivotSample; TUNING.pivot_samples],
) -> Vec<f64> {
    let register_of = registers(inputs);
    let mut largest = vec![0.0_f64; system.constraint.len()];
    for sample in samples {
        let errors = running_errors(&system.graph, &system.constraint, |symbol| sample.values[register_of[&symbol]]);
        largest.iter_mut().zip(errors).for_each(|(largest, error)| *largest = largest.max(error));
    }
    largest
}

/// Symmetric diagonal scaling: unit diagonal for the equations of motion, then unit largest entry for the constraints.
/// A massless coordinate is scaled by the constraints that define it instead, and constraints between massless
/// coordinates after those.
fn equilibrate(matrix: &SparseMatrix, numbers: &[Numbers], massive: &[bool]) -> Vec<f64> {
    let n = massive.len();
    let mut scale = vec![1.0; matrix.rows.len()];
    // A row of Φ may vanish at a singular start, so all samples count.
    let size = |numbers: &Numbers| numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    let entries = || matrix.entries().zip(numbers).map(|((row, column, _), numbers)| (row, column, size(numbers)));
    for (row, column, size) in entries() {
        if row == column && row < n && massive[row] && size > 0.0 {
            scale[row] = 1.0 / size.sqrt();
        }
    }
    let mut largest = vec![0.0_f64; scale.len()];
    let derivatives = || entries().filter(|&(row, column, _)| row >= n && column < n);
    for (row, column, size) in derivatives().filter(|&(_, column, _)| massive[column]) {
        largest[row] = largest[row].max(size * scale[column]);
    }
    let mut massless = vec![0.0_f64; n];
    for (row, column, size) in derivatives().filter(|&(row, column, _)| !massive[column] && largest[row] > 0.0) {
        massless[column] = massless[column].max(size / largest[row]);
    }
    for (scale, size) in scale.iter_mut().zip(massless).filter(|(_, size)| *size > 0.0) {
        *scale = 1.0 / size;
    }
    for (row, column, size) in derivatives().filter(|&(_, column, _)| !massive[column]) {
        largest[row] = largest[row].max(size * scale[column]);
    }
    for (row, &size) in largest.iter().enumerate().skip(n) {
        if size > 0.0 {
            scale[row] = 1.0 / size;
        }
    }
    scale
}
