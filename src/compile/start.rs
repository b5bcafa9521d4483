//! The start as tapes: Gauss–Newton corrections that bring positions, velocities, accelerations and multipliers onto the
//! constraints.
//!
//! ```text
//! positions       [ D  Φ_qᵀ ] [δq]   [ 0 ]        velocities      the same matrix,  right side −(Φ_q v + Φ_t)
//!                 [ Φ_q  −ε ] [μ ] = [−Φ ]
//! accelerations   [ M  Φ_qᵀ − Q_λ ] [δw]     [ M w + Φ_qᵀ λ − Q ]
//!                 [ Φ_q     −ε    ] [δλ] = − [ Φ̈(q, v, w, t)    ]
//! ```
//!
//! Q_λ is there where friction depends on reactions; the corrections are then Newton's.
//!
//! A coordinate without inertia has no pivot in M. Where a constraint k defines it by others, both sides are augmented: μ
//! Φ_kᵀ Φ_k is added to M and μ Φ_kᵀ Φ̈_k to the equations of motion, which changes nothing where Φ̈ = 0.
//!
//! For positions and velocities, Φ has further rows: what holds at the start alone ([`crate::assemble::StartCondition`]).
//!
//! D = diag(1/scale²) makes the change of the coordinates that are not kept smallest; kept ones have no column. ε > 0 makes
//! the matrices quasi-definite (Vanderbei, SIAM J. Optim. 5 (1995) 100): every diagonal elimination order exists, also
//! where constraints are redundant, and the corrections still converge to the exact solution, since the right sides are
//! exact.

use symdiff::{Expr, Graph, Input, Lowered, SparseMatrix, Stages, Tape, lower};

use super::equations::{equations_of_motion, time_derivative};
use super::layout::Layout;
use super::sparse_lu::{NoFactors, Numbers, PIVOT_SAMPLES, Pivoting, factorise};
use crate::assemble::{StartCondition, System};

/// ε relative to a constraint's own size in the matrix's metric.
const REGULARISATION: f64 = 1e-12;

/// The same for constraints known to be redundant: the others do their work, and their multipliers stay near zero.
const RELAXATION: f64 = 1e6;

/// Tapes for the start of a tile of samples; states stand where [`Layout`] says, corrections too.
#[derive(Clone, Debug)]
pub struct StartProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// Slots of Φ, m and those of conditions on positions, after [`StartProgram::position`].
    pub constraint: Vec<usize>,
    /// Slots of Φ̇, m and those of conditions on velocities, after [`StartProgram::velocity`].
    pub constraint_rate: Vec<usize>,
    /// Slots of the outputs after [`StartProgram::observe`].
    pub outputs: Vec<usize>,
    /// Φ_q's entries (constraint, coordinate, slot) after [`StartProgram::jacobian`].
    pub jacobian_entries: Vec<(usize, usize, usize)>,
    lowered: Lowered,
}

const GIVEN: usize = 0;
const GUESS: usize = 1;
const POSITION: usize = 2;
const VELOCITY: usize = 3;
const ACCELERATION: usize = 4;
const JACOBIAN: usize = 5;
const OBSERVE: usize = 6;

impl StartProgram {
    /// Number of slots of a tile.
    pub fn slots(&self) -> usize {
        self.lowered.slots
    }

    /// Numbers that a new tile holds.
    pub fn constants(&self) -> &[(u32, f64)] {
        &self.lowered.constants
    }

    /// Once a sample.
    pub fn sample(&self) -> &Tape {
        &self.lowered.stages[0]
    }

    /// Sets the positions and velocities that are kept.
    pub fn given(&self) -> &Tape {
        &self.lowered.kernels[GIVEN]
    }

    /// Sets all positions to the guess.
    pub fn guess(&self) -> &Tape {
        &self.lowered.kernels[GUESS]
    }

    /// Correction of the positions (first n of `correction`), and Φ.
    pub fn position(&self) -> &Tape {
        &self.lowered.kernels[POSITION]
    }

    /// Correction of the velocities (first n of `correction`), and Φ̇.
    pub fn velocity(&self) -> &Tape {
        &self.lowered.kernels[VELOCITY]
    }

    /// Correction of accelerations and multipliers.
    pub fn acceleration(&self) -> &Tape {
        &self.lowered.kernels[ACCELERATION]
    }

    /// Outputs of the state.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// Φ_q.
    pub fn jacobian(&self) -> &Tape {
        &self.lowered.kernels[JACOBIAN]
    }
}

/// Compiles the start of a system. `redundant` are constraints that others imply, as far as known; `probe` is a state near the one that is looked for (values of the layout's slots).
///
/// # Errors
/// Where the equations have no finite values at the probe (rows: motion, constraints, then start conditions), and where
/// the graph is full.
pub fn compile_start(system: &System, redundant: &[usize], probe: &[f64]) -> Result<StartProgram, NoFactors> {
    let layout = Layout::new(system.parameters.len(), system.q.len(), system.lambda.len());
    let inputs = inputs(system, &layout);
    let mut graph = system.graph.clone();
    let (motion, slopes) = equations_of_motion(system, &mut graph);
    let rate = time_derivative(system, &mut graph, &system.constraint);
    let rate_of_rate = time_derivative(system, &mut graph, &rate);
    let (of_position, of_velocity): (Kind, Kind) = (|condition| condition.position, |condition| condition.velocity);
    let (further, place_slopes) = with_conditions(system, &mut graph, &slopes, of_position);
    let closure = [&system.constraint[..], &further].concat();
    let (further, motion_slopes) = with_conditions(system, &mut graph, &slopes, of_velocity);
    let rates = [rate, time_derivative(system, &mut graph, &further)].concat();

    let mut builder = Builder { system, graph, inputs: &inputs, redundant, probe };
    let metric: Vec<f64> = system.coordinates.iter().map(|coordinate| coordinate.scale.powi(-2)).collect();
    let diagonal: Vec<(usize, usize, Expr)> =
        metric.iter().enumerate().map(|(i, &weight)| (i, i, builder.graph.constant(weight))).collect();
    let kept = |values: &[Option<Expr>]| values.iter().map(Option::is_some).collect::<Vec<bool>>();
    let zero = vec![builder.graph.constant(0.0); system.q.len()];
    let none = SparseMatrix::zero(system.q.len(), system.lambda.len());
    let position = builder
        .correction(&diagonal, &none, &place_slopes, &kept(&system.start.position), &zero, &closure)
        .map_err(|none| numbered(system, none, of_position))?;
    let velocity = builder
        .correction(&diagonal, &none, &motion_slopes, &kept(&system.start.velocity), &zero, &rates)
        .map_err(|none| numbered(system, none, of_velocity))?;
    let by_multiplier = builder.graph.jacobian(&system.force, &system.lambda);
    let (mass, motion) = builder.with_defined_coordinates(&slopes, motion, &rate_of_rate);
    let free = vec![false; system.q.len()];
    let acceleration = builder.correction(&mass, &by_multiplier, &slopes, &free, &motion, &rate_of_rate)?;
    let graph = builder.graph;

    let at = |values: &[Expr], start: usize| -> Vec<(Expr, Option<u32>)> {
        values.iter().zip(start..).map(|(&value, slot)| (value, Some(slot as u32))).collect()
    };
    let mut given = Vec::new();
    for (values, block) in [(&system.start.position, &layout.q), (&system.start.velocity, &layout.v)] {
        given
            .extend(values.iter().zip(block.clone()).filter_map(|(value, slot)| value.map(|v| (v, Some(slot as u32)))));
    }
    let guess = at(&system.start.guess, layout.q.start);
    let with = |correction: &[Expr], further: &[Expr]| {
        let mut outputs = at(correction, layout.correction.start);
        outputs.extend(further.iter().map(|&value| (value, None)));
        outputs
    };
    let n = system.q.len();
    let kernels = [
        given,
        guess,
        with(&position[..n], &closure),
        with(&velocity[..n], &rates),
        with(&acceleration, &[]),
        slopes.entries().map(|(_, _, value)| (value, None)).collect(),
        system.outputs.iter().map(|output| (output.expr, None)).collect(),
    ];
    let lowered = lower(&graph, &inputs, 1, layout.slots() as u32, &kernels);
    let tail = |kernel: usize, skip: usize| {
        lowered.outputs[kernel].iter().skip(skip).map(|&slot| slot as usize).collect::<Vec<_>>()
    };
    let jacobian_entries =
        slopes.entries().zip(tail(JACOBIAN, 0)).map(|((row, column, _), slot)| (row, column, slot)).collect();
    Ok(StartProgram {
        constraint: tail(POSITION, n),
        constraint_rate: tail(VELOCITY, n),
        outputs: tail(OBSERVE, 0),
        jacobian_entries,
        layout,
        lowered,
    })
}

/// Parameters at stage 0, everything else at stage 1.
pub(super) fn inputs(system: &System, layout: &Layout) -> Vec<Input> {
    let mut inputs = Vec::new();
    let mut add = |symbols: &[Expr], start: usize, stage: usize| {
        inputs.extend(symbols.iter().zip(start..).map(|(&symbol, slot)| Input { symbol, stage, slot: slot as u32 }));
    };
    let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    add(&parameters, layout.parameters.start, 0);
    add(&[system.time], layout.time, 1);
    add(&system.q, layout.q.start, 1);
    add(&system.v, layout.v.start, 1);
    add(&system.w, layout.w.start, 1);
    add(&system.lambda, layout.lambda.start, 1);
    inputs
}

/// Conditions on positions, or those on velocities.
type Kind = fn(&StartCondition) -> bool;

/// Rows of conditions of some kind, which stand behind the constraints, by their numbers among all conditions.
fn numbered(system: &System, none: NoFactors, kind: Kind) -> NoFactors {
    let NoFactors::Singular { rows } = none else { return none };
    let first = system.q.len() + system.constraint.len();
    let conditions: Vec<usize> =
        (0..system.start.conditions.len()).filter(|&place| kind(&system.start.conditions[place])).collect();
    let row = |row: usize| if row < first { row } else { first + conditions[row - first] };
    NoFactors::Singular { rows: rows.into_iter().map(row).collect() }
}

/// The conditions of some kind, and Φ_q with theirs below it.
fn with_conditions(system: &System, graph: &mut Graph, slopes: &SparseMatrix, kind: Kind) -> (Vec<Expr>, SparseMatrix) {
    let conditions = system.start.conditions.iter().filter(|condition| kind(condition));
    let values: Vec<Expr> = conditions.map(|condition| condition.value).collect();
    let mut all = slopes.clone();
    all.rows.extend(graph.jacobian(&values, &system.q).rows);
    (values, all)
}

struct Builder<'s> {
    system: &'s System,
    graph: Graph,
    inputs: &'s [Input],
    redundant: &'s [usize],
    probe: &'s [f64],
}

impl Builder<'_> {
    /// Solution of [metric Φ_qᵀ − `loaded`; Φ_q −ε] (δ, μ) = −(first, second), n + rows of Φ; kept coordinates have δ = 0.
    fn correction(
        &mut self,
        metric: &[(usize, usize, Expr)],
        loaded: &SparseMatrix,
        slopes: &SparseMatrix,
        kept: &[bool],
        first: &[Expr],
        second: &[Expr],
    ) -> Result<Vec<Expr>, NoFactors> {
        let (n, m) = (self.system.q.len(), slopes.rows.len());
        let (one, mut matrix) = (self.graph.constant(1.0), SparseMatrix::zero(n + m, n + m));
        for &(row, column, value) in metric.iter().filter(|(row, column, _)| !kept[*row] && !kept[*column]) {
            matrix.add(&mut self.graph, row, column, value);
        }
        for (row, column, value) in slopes.entries().filter(|(_, column, _)| !kept[*column]) {
            matrix.add(&mut self.graph, n + row, column, value);
            matrix.add(&mut self.graph, column, n + row, value);
        }
        for (row, column, value) in loaded.entries() {
            let value = self.graph.neg(value);
            matrix.add(&mut self.graph, row, n + column, value);
        }
        for coordinate in (0..n).filter(|&coordinate| kept[coordinate]) {
            matrix.add(&mut self.graph, coordinate, coordinate, one);
        }
        let numbers = self.numbers(&matrix);
        let sizes = self.constraint_sizes(&matrix, &numbers, n);
        let mut scale = vec![1.0; n + m];
        for (constraint, size) in sizes.into_iter().enumerate() {
            let relaxed = self.redundant.contains(&constraint);
            let value = self.graph.constant(-size * if relaxed { RELAXATION } else { REGULARISATION });
            matrix.add(&mut self.graph, n + constraint, n + constraint, value);
            scale[n + constraint] = size.sqrt().recip();
        }
        let numbers = self.numbers(&matrix);
        for (place, (row, column, _)) in matrix.entries().enumerate() {
            if row == column && row < n {
                scale[row] = numbers[place][0].abs().sqrt().recip();
            }
        }
        let stages = Stages::new(self.inputs);
        let factors =
            factorise(&mut self.graph, &matrix, &numbers, &scale, stages, 1, Pivoting::Diagonal { constraints: n })?;
        let mut right: Vec<Expr> = first.iter().chain(second).map(|&value| self.graph.neg(value)).collect();
        let zero = self.graph.constant(0.0);
        kept.iter().zip(&mut right).filter(|(kept, _)| **kept).for_each(|(_, value)| *value = zero);
        Ok(factors.solve(&mut self.graph, &right))
    }

    /// M and the equations of motion, augmented by the constraints that define coordinates without inertia. μ makes the
    /// defined coordinate about as heavy as those that define it.
    fn with_defined_coordinates(
        &mut self,
        slopes: &SparseMatrix,
        mut motion: Vec<Expr>,
        rate_of_rate: &[Expr],
    ) -> (Vec<(usize, usize, Expr)>, Vec<Expr>) {
        let mut mass = self.system.mass.clone();
        let mut diagonal = vec![0.0; self.system.q.len()];
        let entries: Vec<Expr> = mass.iter().map(|&(_, _, value)| value).collect();
        for (&(row, column, _), value) in mass.iter().zip(self.at_probe(&entries)) {
            if row == column {
                diagonal[row] = value;
            }
        }
        for (constraint, slopes) in slopes.rows.iter().enumerate() {
            let defines = slopes.iter().any(|&(column, _)| diagonal[column] == 0.0);
            let weight = slopes.iter().fold(0.0, |heaviest: f64, &(column, _)| heaviest.max(diagonal[column]));
            if !defines || weight == 0.0 {
                continue;
            }
            for &(row, slope) in slopes {
                let pull = self.graph.scale(weight, slope);
                let residual = self.graph.mul(pull, rate_of_rate[constraint]);
                motion[row] = self.graph.add(motion[row], residual);
                for &(column, other) in slopes {
                    mass.push((row, column, self.graph.mul(pull, other)));
                }
            }
        }
        (mass, motion)
    }

    /// Values at the probe.
    fn at_probe(&self, exprs: &[Expr]) -> Vec<f64> {
        let slot_of: rustc_hash::FxHashMap<Expr, usize> =
            self.inputs.iter().map(|input| (input.symbol, input.slot as usize)).collect();
        self.graph.evaluate(exprs, |symbol| self.probe[slot_of[&symbol]])
    }

    fn numbers(&self, matrix: &SparseMatrix) -> Vec<Numbers> {
        let entries: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
        self.at_probe(&entries).into_iter().map(|value| [value; PIVOT_SAMPLES]).collect()
    }

    /// Σ Φ_ki² / metric_ii: a constraint's own entry in Φ_q metric⁻¹ Φ_qᵀ; 1 where nothing of it is left.
    fn constraint_sizes(&self, matrix: &SparseMatrix, numbers: &[Numbers], n: usize) -> Vec<f64> {
        let mut diagonal = vec![1.0; n];
        let mut sizes = vec![0.0; matrix.rows.len() - n];
        let entries = || matrix.entries().zip(numbers).map(|((row, column, _), number)| (row, column, number[0]));
        entries().filter(|&(row, column, _)| row == column).for_each(|(row, _, value)| diagonal[row] = value);
        entries().filter(|&(row, column, _)| row >= n && column < n).for_each(|(row, column, value)| {
            sizes[row - n] += value * value / diagonal[column];
        });
        sizes.into_iter().map(|size| if size > 0.0 { size } else { 1.0 }).collect()
    }
}
