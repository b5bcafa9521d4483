//! System → [`Program`]: the step's tapes.

use symdiff::{Expr, Graph, Input, Lowered, SparseMatrix, Stages, Tape, lower_where};

use super::elimination::{Choice, Elimination, Version, is_worth_it};
use super::layout::Layout;
use super::newton_matrix::{ITERATION, NewtonSystem, STEP_SIZE, newton_system};
use super::scheme::{Coefficients, Scheme};
use super::sparse_lu::{NoFactors, Numbers, PIVOT_SAMPLES, Pivoting};
use crate::assemble::System;

/// A state that guides the choice of pivots: values of the layout's first slots (parameters to λ), at a step size.
#[derive(Clone, Debug, PartialEq)]
pub struct PivotSample {
    /// Values of the slots below `layout.slots()`.
    pub values: Vec<f64>,
}

/// A pivot that can change, its slot, and how small it may become before the factorisation is not trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedPivot {
    /// Slot of 1/pivot.
    pub slot: usize,
    /// Largest |1/pivot| that is trusted.
    pub largest_inverse: f64,
}

/// Which lanes solve with a version of the factors, told by what is kept of the iterate at which they were made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Slot of what decides.
    pub slot: usize,
    /// Whether it is those where it is not positive.
    pub elsewhere: bool,
}

impl Mode {
    /// Whether a lane with this value is one of them.
    #[inline(always)]
    pub fn holds(&self, value: f64) -> bool {
        (value <= 0.0) == self.elsewhere
    }
}

/// The pivots of one version of the factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Which lanes use it; all, where there is one version.
    pub mode: Option<Mode>,
    /// Its pivots that can change.
    pub pivots: Vec<WatchedPivot>,
}

/// Compiled form of a system for one scheme. A tile of samples has [`Program::slots`] slots.
#[derive(Clone, Debug)]
pub struct Program {
    /// Where states stand.
    pub layout: Layout,
    /// The scheme's numbers.
    pub coefficients: Coefficients,
    /// Typical size of each coordinate, n.
    pub scale: Vec<f64>,
    /// Slots of the outputs after [`Program::observe`].
    pub outputs: Vec<usize>,
    /// Slots of the Newton matrix's entries (row, column, slot) after [`Program::matrix`].
    pub matrix_entries: Vec<(usize, usize, usize)>,
    /// Slots of the residual after [`Program::matrix`], n + m.
    pub residual: Vec<usize>,
    /// Slots of the multipliers of redundant constraints: reactions that equilibrium does not determine, taken as zero.
    pub redundant: Vec<usize>,
    /// Pivots that can become small, of each version of the factors.
    pub watched: Vec<Watched>,
    /// Symmetric scaling that equilibrates the Newton matrix, n + m.
    pub equilibration: Vec<f64>,
    /// Nonzeros of the Newton matrix and of its factors.
    pub nonzeros: (usize, usize),
    /// Equation and unknown of each pivot, in the order of elimination.
    pub pivots: Vec<(usize, usize)>,
    lowered: Lowered,
}

const FACTOR: usize = 0;
const CORRECT: usize = 1;
const ADVANCE: usize = 2;
const OBSERVE: usize = 3;
const MATRIX: usize = 4;
const ESTIMATE: usize = 5;

impl Program {
    /// Number of slots of a tile.
    pub fn slots(&self) -> usize {
        self.lowered.slots
    }

    /// Numbers that a new tile holds.
    pub fn constants(&self) -> &[(u32, f64)] {
        &self.lowered.constants
    }

    /// Once a sample: what depends on parameters only.
    pub fn sample(&self) -> &Tape {
        &self.lowered.stages[0]
    }

    /// When h has changed.
    pub fn step_size(&self) -> &Tape {
        &self.lowered.stages[1]
    }

    /// Once a step, after `time` was set to t₊: what is known when it begins.
    pub fn step(&self) -> &Tape {
        &self.lowered.stages[2]
    }

    /// Newton matrix at the iterate, factorised.
    pub fn factor(&self) -> &Tape {
        &self.lowered.kernels[FACTOR]
    }

    /// Residual at the iterate and, with the factors at hand, the correction.
    pub fn correct(&self) -> &Tape {
        &self.lowered.kernels[CORRECT]
    }

    /// The state becomes the one at the step's end.
    pub fn advance(&self) -> &Tape {
        &self.lowered.kernels[ADVANCE]
    }

    /// Outputs of the state.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// Newton matrix and residual at the iterate, for the rank-revealing solve.
    pub fn matrix(&self) -> &Tape {
        &self.lowered.kernels[MATRIX]
    }

    /// In the correction's first n slots the part of a₊ − a that moves the mechanism, J⁻¹(M (a₊ − a), 0), with the factors at hand:
    /// after the iteration, and before the state is advanced.
    pub fn estimate(&self) -> &Tape {
        &self.lowered.kernels[ESTIMATE]
    }

    /// Slots that the factors occupy.
    pub fn factor_slots(&self) -> &[u32] {
        &self.lowered.outputs[FACTOR]
    }
}

/// Compiles a system. `redundant` are constraints that others imply; `probes` are states near which pivots shall be good.
///
/// # Errors
/// Where the Newton matrix has no acceptable pivots at the probes, and where the graph is full.
pub fn compile(
    system: &System,
    scheme: Scheme,
    redundant: &[usize],
    probes: &[PivotSample; PIVOT_SAMPLES],
) -> Result<Program, NoFactors> {
    let (n, m) = (system.q.len(), system.lambda.len());
    let layout = Layout::new(system.parameters.len(), n, m);
    let coefficients = scheme.coefficients();
    let mut graph = system.graph.clone();
    let (newton, mut inputs) = newton_system(system, &mut graph, &layout, coefficients);
    let numbers = probe_numbers(&graph, &newton.matrix, &inputs, probes);
    let mut heavy = vec![false; n];
    system.mass.iter().filter(|(row, column, _)| row == column).for_each(|&(row, _, _)| heavy[row] = true);
    let blocks = mass_blocks(system);
    let symmetric = Pivoting::Symmetric { heavy: &heavy, blocks: &blocks };
    let choice = Choice { redundant, symmetric, spatial: system.space.spatial, n };
    let factorised = |graph: &mut Graph, matrix: &SparseMatrix, numbers: &[Numbers]| {
        choice.factorise(graph, matrix, numbers, equilibrate(matrix, numbers, &heavy), &inputs)
    };
    let versions = versions(&mut graph, &newton, &numbers, &inputs).and_then(|[all, apart]| {
        let apart_numbers = probe_numbers(&graph, &apart.0, &inputs, probes);
        // Where elimination needs what touches, there is no other version.
        let all = factorised(&mut graph, &all.0, &all.1).ok()?;
        let apart = factorised(&mut graph, &apart.0, &apart_numbers).ok()?;
        is_worth_it(&graph, &inputs, &all, &apart).then_some((all, apart))
    });
    let (all, apart) = match (versions, newton.touching) {
        (Some((all, apart)), Some(touching)) => (all, Some((touching, apart))),
        _ => (factorised(&mut graph, &newton.matrix, &numbers)?, None),
    };
    let mut next = layout.slots() as u32;
    let elimination = Elimination::new(&mut graph, &mut inputs, &mut next, all, apart);

    let opposite: Vec<Expr> = newton.residual.iter().map(|&value| graph.neg(value)).collect();
    let correction = elimination.solve(&mut graph, &opposite);
    let mut changes = newton.inertial_change.clone();
    changes.resize(n + m, graph.constant(0.0));
    let moving = elimination.solve(&mut graph, &changes);

    let at = |values: &[Expr], start: usize| -> Vec<(Expr, Option<u32>)> {
        values.iter().zip(start..).map(|(&value, slot)| (value, Some(slot as u32))).collect()
    };
    let correct = at(&correction, layout.correction.start);
    let mut advance = at(&newton.position, layout.q.start);
    advance.extend(at(&newton.velocity, layout.v.start));
    advance.extend(at(&newton.algorithmic, layout.a.start));
    advance.extend(at(&newton.acceleration, layout.w.start));
    let observe = system.outputs.iter().map(|output| (output.expr, None)).collect();
    let mut matrix: Vec<(Expr, Option<u32>)> = newton.matrix.entries().map(|(_, _, value)| (value, None)).collect();
    matrix.extend(newton.residual.iter().map(|&value| (value, None)));

    let estimate = at(&moving[..n], layout.correction.start);
    let Elimination { frozen, guards, watched, all: Version { factors, equilibration }, .. } = elimination;
    let guards = guards.into_iter().map(|(value, guard)| ((FACTOR, value), guard)).collect();
    let kernels = [frozen, correct, advance, observe, matrix, estimate];
    let lowered = lower_where(&graph, &inputs, ITERATION, next, &kernels, &guards);
    debug_assert_eq!(lowered.stages.len(), STEP_SIZE + 2);
    let nonzeros = newton.matrix.nonzeros();
    let places = &lowered.outputs[MATRIX];
    let matrix_entries =
        newton.matrix.entries().zip(places).map(|((row, column, _), &slot)| (row, column, slot as usize)).collect();
    Ok(Program {
        coefficients,
        scale: system.coordinates.iter().map(|coordinate| coordinate.scale).collect(),
        outputs: lowered.outputs[OBSERVE].iter().map(|&slot| slot as usize).collect(),
        matrix_entries,
        residual: places[nonzeros..].iter().map(|&slot| slot as usize).collect(),
        redundant: redundant.iter().map(|&constraint| layout.lambda.start + constraint).collect(),
        watched,
        equilibration,
        nonzeros: (nonzeros, factors.nonzeros()),
        pivots: factors.pivots.iter().map(|pivot| (pivot.row, pivot.column)).collect(),
        layout,
        lowered,
    })
}

/// The Newton matrix where something touches, with its numbers, and where nothing does, if that is another one.
fn versions(
    graph: &mut Graph,
    newton: &NewtonSystem,
    numbers: &[Numbers],
    inputs: &[Input],
) -> Option<[(SparseMatrix, Vec<Numbers>); 2]> {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    // What the iteration does not change needs no elimination that tells one from the other while it runs.
    let touching = newton.touching.filter(|&touching| stages.of(touching) == Some(ITERATION))?;
    let values: Vec<Expr> = newton.matrix.entries().map(|(_, _, value)| value).collect();
    let versions = [true, false].map(|holds| {
        let (mut matrix, mut kept) = (SparseMatrix::zero(newton.matrix.rows.len(), newton.matrix.columns), Vec::new());
        let values = graph.assume(&values, touching, holds);
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

/// By coordinate, the first of those that M couples it with: of a body with coordinates of its own, or of a tree.
fn mass_blocks(system: &System) -> Vec<usize> {
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

/// Values of the matrix's entries at each probe.
fn probe_numbers(graph: &Graph, matrix: &SparseMatrix, inputs: &[Input], probes: &[PivotSample; PIVOT_SAMPLES]) -> Vec<Numbers> {
    let slot_of: rustc_hash::FxHashMap<Expr, usize> =
        inputs.iter().map(|input| (input.symbol, input.slot as usize)).collect();
    let entries: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
    let values: Vec<Vec<f64>> =
        probes.iter().map(|probe| graph.evaluate(&entries, |symbol| probe.values[slot_of[&symbol]])).collect();
    (0..entries.len()).map(|entry| std::array::from_fn(|probe| values[probe][entry])).collect()
}

/// Symmetric diagonal scaling: unit diagonal for the equations of motion, then unit largest entry for the constraints. A
/// coordinate without inertia (`heavy` says which have some) is scaled by the constraints that define it instead, and
/// constraints between such coordinates after those.
fn equilibrate(matrix: &SparseMatrix, numbers: &[Numbers], heavy: &[bool]) -> Vec<f64> {
    let n = heavy.len();
    let mut scale = vec![1.0; matrix.rows.len()];
    // At the start alone a row of Φ may vanish: then it is singular.
    let size = |numbers: &Numbers| numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    let entries = || matrix.entries().zip(numbers).map(|((row, column, _), numbers)| (row, column, size(numbers)));
    for (row, column, size) in entries() {
        if row == column && row < n && heavy[row] && size > 0.0 {
            scale[row] = 1.0 / size.sqrt();
        }
    }
    let mut largest = vec![0.0_f64; scale.len()];
    let slopes = || entries().filter(|&(row, column, _)| row >= n && column < n);
    for (row, column, size) in slopes().filter(|&(_, column, _)| heavy[column]) {
        largest[row] = largest[row].max(size * scale[column]);
    }
    let mut light = vec![0.0_f64; n];
    for (row, column, size) in slopes().filter(|&(row, column, _)| !heavy[column] && largest[row] > 0.0) {
        light[column] = light[column].max(size / largest[row]);
    }
    for (scale, size) in scale.iter_mut().zip(light).filter(|(_, size)| *size > 0.0) {
        *scale = 1.0 / size;
    }
    for (row, column, size) in slopes().filter(|&(_, column, _)| !heavy[column]) {
        largest[row] = largest[row].max(size * scale[column]);
    }
    for (row, &size) in largest.iter().enumerate().skip(n) {
        if size > 0.0 {
            scale[row] = 1.0 / size;
        }
    }
    scale
}
